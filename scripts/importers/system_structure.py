"""What a system structure package says, read with nothing but an XML parser: SSP 1.0 and 2.0."""

from __future__ import annotations

from pathlib import Path
from zipfile import ZipFile

from cosimulation import Value
from lxml import etree

STRUCTURE = "SystemStructure.ssd"
NAMESPACES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
    "osp": "http://opensimulationplatform.com/SSP/OSPAnnotations",
}
ENDS = ("startElement", "startConnector", "endElement", "endConnector")

ParameterValues = dict[str, dict[str, Value]]
"""Values by element and variable."""
Connection = tuple[str | None, str, str | None, str]
"""Start element, start connector, end element, end connector; no element is the system."""


class SystemStructure:
    """Elements, connectors, connections, and the parameters that are bound."""

    def __init__(self, package: Path) -> None:
        with ZipFile(package) as archive:
            root = etree.fromstring(archive.read(STRUCTURE))
            components = root.findall("ssd:System/ssd:Elements/ssd:Component", NAMESPACES)
            self.parameters: ParameterValues = {
                component.get("name"): {
                    name: value
                    for binding in component.iterfind("ssd:ParameterBindings/ssd:ParameterBinding", NAMESPACES)
                    for name, value in read_set(archive.read(binding.get("source")))
                }
                for component in components
            }
        self.version = root.get("version")
        self.sources = {component.get("name"): component.get("source") for component in components}
        self.connections: list[Connection] = [
            tuple(connection.get(end) for end in ENDS)
            for connection in root.iterfind("ssd:System/ssd:Connections/ssd:Connection", NAMESPACES)
        ]
        self.connectors = {
            (None if owner.tag.endswith("System") else owner.get("name"), connector.get("name"))
            for owner in [root.find("ssd:System", NAMESPACES), *components]
            for connector in owner.iterfind("ssd:Connectors/ssd:Connector", NAMESPACES)
        }
        step = root.find("ssd:DefaultExperiment//osp:FixedStepAlgorithm", NAMESPACES)
        self.step_size = float(step.get("baseStepSize"))

    @property
    def inner_connections(self) -> list[tuple[str, str, str, str]]:
        """Those from model to model."""
        return [wire for wire in self.connections if wire[0] is not None and wire[2] is not None]

    def element(self, kind: str) -> str:
        """Name of the element whose model is a `Plant` or a `Controller`."""
        return next(name for name in self.sources if name.endswith(kind))


def read_set(text: bytes) -> list[tuple[str, Value]]:
    """Names and values of a parameter set; of an enumeration the item's name."""
    parameters = etree.fromstring(text).iterfind("ssv:Parameters/ssv:Parameter", NAMESPACES)
    return [(parameter.get("name"), value_of(parameter[0])) for parameter in parameters]


def value_of(element: etree._Element) -> Value:
    kind, text = etree.QName(element).localname, element.get("value")
    if kind == "Boolean":
        return text == "true"
    if kind in ("Integer", "Int32"):
        return int(text)
    return float(text) if kind in ("Real", "Float64") else text
