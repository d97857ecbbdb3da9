//! A small model of both versions for the host's tests, compiled here: `y <- a y + b u` in every step.
//!
//! It misbehaves on request, which no honest FMU does.

use std::fs::File;
use std::io::Write;
use std::process::Command;
use std::sync::OnceLock;

use maglev_fmu::host::{Fmu, HostError};
use zip::ZipWriter;
use zip::write::SimpleFileOptions;

/// Both interfaces in one library. Step sizes 97, 98, 99 and below 0 ask for trouble.
const MODEL: &str = include_str!("library.rs");

pub const FMI2: &str = r#"<fmiModelDescription fmiVersion="2.0" modelName="Two" guid="right">
<CoSimulation modelIdentifier="model"/>
<TypeDefinitions><SimpleType name="Mode"><Enumeration><Item name="idle" value="0"/><Item name="busy" value="5"/></Enumeration></SimpleType></TypeDefinitions>
<ModelVariables>
<ScalarVariable name="u" valueReference="0" causality="input"><Real unit="V"/></ScalarVariable>
<ScalarVariable name="y" valueReference="1" causality="output"><Real unit="m"/></ScalarVariable>
<ScalarVariable name="a" valueReference="2" causality="parameter"><Real/></ScalarVariable>
<ScalarVariable name="b" valueReference="3" causality="parameter"><Real/></ScalarVariable>
<ScalarVariable name="steps" valueReference="0" causality="output"><Integer/></ScalarVariable>
<ScalarVariable name="mode" valueReference="1" causality="parameter"><Enumeration declaredType="Mode"/></ScalarVariable>
<ScalarVariable name="flag" valueReference="0" causality="input"><Boolean/></ScalarVariable>
<ScalarVariable name="text" valueReference="0" causality="local"><String/></ScalarVariable>
</ModelVariables></fmiModelDescription>"#;

pub const FMI3: &str = r#"<fmiModelDescription fmiVersion="3.0" modelName="Three" instantiationToken="right">
<CoSimulation modelIdentifier="model"/>
<TypeDefinitions><EnumerationType name="Mode"><Item name="idle" value="0"/><Item name="busy" value="5"/></EnumerationType></TypeDefinitions>
<ModelVariables>
<Float64 name="u" valueReference="0" causality="input" unit="V"/>
<Float64 name="y" valueReference="1" causality="output" unit="m"/>
<Float64 name="a" valueReference="2" causality="parameter"/>
<Float64 name="b" valueReference="3" causality="parameter"/>
<Float64 name="vector" valueReference="4" causality="parameter"><Dimension start="3"/></Float64>
<Int64 name="steps" valueReference="5" causality="output"/>
<Enumeration name="mode" valueReference="6" declaredType="Mode" causality="parameter"/>
<Boolean name="flag" valueReference="7" causality="input"/>
<Int16 name="text" valueReference="8"/>
</ModelVariables></fmiModelDescription>"#;

/// Compiles a shared library.
pub fn compile(source_text: &str) -> Vec<u8> {
    let directory = tempfile::tempdir().unwrap();
    let source = directory.path().join("model.rs");
    let target = directory.path().join("model.bin");
    std::fs::write(&source, source_text).unwrap();
    let compiler = std::env::var_os("RUSTC").unwrap_or_else(|| "rustc".into());
    let status = Command::new(compiler)
        .args(["--edition=2021", "--crate-type=cdylib", "-Copt-level=1", "-Anon_snake_case", "-o"])
        .args([&target, &source])
        .status()
        .expect("the compiler that built this test");
    assert!(status.success());
    std::fs::read(target).unwrap()
}

/// Packs an FMU and opens it.
pub fn open_with(description: &str, library: &[u8]) -> Result<Fmu, HostError> {
    let directory = tempfile::tempdir().unwrap();
    let path = directory.path().join("model.fmu");
    let mut zip = ZipWriter::new(File::create(&path).unwrap());
    let system = if std::env::consts::OS == "macos" { "darwin" } else { std::env::consts::OS };
    let library_name =
        format!("binaries/{}-{system}/model.{}", std::env::consts::ARCH, std::env::consts::DLL_EXTENSION);
    for (name, content) in
        [("modelDescription.xml", description.as_bytes()), (library_name.as_str(), library)]
    {
        zip.start_file(name, SimpleFileOptions::default()).unwrap();
        zip.write_all(content).unwrap();
    }
    zip.finish().unwrap();
    Fmu::open(&path)
}

pub fn open(description: &str) -> Result<Fmu, HostError> {
    static MODEL_LIBRARY: OnceLock<Vec<u8>> = OnceLock::new();
    open_with(description, MODEL_LIBRARY.get_or_init(|| compile(MODEL)))
}

pub fn both() -> [Fmu; 2] {
    [FMI2, FMI3].map(|description| open(description).unwrap())
}
