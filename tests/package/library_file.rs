//! Files that pass for shared libraries of the three platforms: well-formed, with exports, and without code.

use std::fs;
use std::path::{Path, PathBuf};

use maglev_fmu::fmi::{FmiVersion, function_names};
use maglev_fmu::model::{MODELS, editions_of};
use object::pe;
use object::write::elf::{FileHeader, Sym, Writer as ElfWriter};
use object::write::pe::{NtHeaders, Writer as PeWriter};
use object::write::{Object, StandardSection, Symbol, SymbolSection};
use object::{Architecture, BinaryFormat, Endianness, SymbolFlags, SymbolKind, SymbolScope, elf, macho};

/// Every function of both standards.
pub fn all_functions() -> Vec<&'static str> {
    FmiVersion::ALL.iter().flat_map(|version| function_names(*version)).copied().collect()
}

/// A library of these functions, followed by the names and tokens of all models and something to compress.
pub fn library(format: BinaryFormat, architecture: Architecture, functions: &[&str]) -> Vec<u8> {
    let mut bytes = match format {
        BinaryFormat::Elf => elf(architecture, functions),
        BinaryFormat::Pe => dll(architecture, functions),
        BinaryFormat::MachO => dylib(architecture, functions),
        other => panic!("no library in the format {other:?}"),
    };
    MODELS.iter().for_each(|model| bytes.extend(model.description.name.bytes()));
    editions_of(MODELS.iter().copied())
        .for_each(|(model, edition)| bytes.extend(edition.token(model.description).as_str().bytes()));
    bytes.extend((0..25_000u32).flat_map(|number| number.wrapping_mul(number).to_le_bytes()));
    bytes
}

/// Writes a library of the models for Linux to a directory.
pub fn write_library(directory: &Path, architecture: Architecture) -> PathBuf {
    let path = directory.join(format!("library-{architecture:?}.so"));
    fs::write(&path, library(BinaryFormat::Elf, architecture, &all_functions())).unwrap();
    path
}

fn elf(architecture: Architecture, functions: &[&str]) -> Vec<u8> {
    let e_machine = match architecture {
        Architecture::X86_64 => elf::EM_X86_64,
        Architecture::Aarch64 => elf::EM_AARCH64,
        _ => elf::EM_386,
    };
    let mut bytes = Vec::new();
    let mut writer = ElfWriter::new(Endianness::Little, true, &mut bytes);
    writer.reserve_file_header();
    writer.reserve_null_section_index();
    let section = writer.reserve_shstrtab_section_index();
    writer.reserve_dynstr_section_index();
    writer.reserve_dynsym_section_index();
    let names: Vec<_> = functions.iter().map(|name| writer.add_dynamic_string(name.as_bytes())).collect();
    writer.reserve_null_dynamic_symbol_index();
    for _ in &names {
        writer.reserve_dynamic_symbol_index();
    }
    writer.reserve_dynsym();
    writer.reserve_dynstr().unwrap();
    writer.reserve_shstrtab().unwrap();
    writer.reserve_section_headers();

    let header = FileHeader {
        os_abi: elf::ELFOSABI_NONE,
        abi_version: 0,
        e_type: elf::ET_DYN,
        e_machine,
        e_entry: 0,
        e_flags: Default::default(),
    };
    writer.write_file_header(&header).unwrap();
    writer.write_null_dynamic_symbol();
    for name in names {
        let symbol = Sym {
            st_name: writer.dynamic_string_offset(Some(name)),
            section: Some(section.0),
            st_info: elf::SymbolInfo::new(elf::STB_GLOBAL, elf::STT_FUNC),
            st_other: Default::default(),
            st_shndx: Default::default(),
            st_value: 0,
            st_size: 0,
        };
        writer.write_dynamic_symbol(&symbol);
    }
    writer.write_dynstr();
    writer.write_shstrtab();
    writer.write_null_section_header();
    writer.write_shstrtab_section_header();
    writer.write_dynstr_section_header(0);
    writer.write_dynsym_section_header(0, 1);
    bytes
}

fn dll(architecture: Architecture, functions: &[&str]) -> Vec<u8> {
    let machine = match architecture {
        Architecture::X86_64 => pe::IMAGE_FILE_MACHINE_AMD64,
        Architecture::Aarch64 => pe::IMAGE_FILE_MACHINE_ARM64,
        _ => pe::IMAGE_FILE_MACHINE_I386,
    };
    let mut bytes = Vec::new();
    let mut writer = PeWriter::new(true, 0x1000, 0x200, &mut bytes);
    writer.reserve_dos_header();
    writer.reserve_nt_headers(16);
    writer.reserve_section_headers(1);
    let table = |start: u32| export_table(start, functions);
    // The table's size does not depend on its place.
    let section = writer.reserve_edata_section(table(0).len() as u32);
    writer.write_empty_dos_header().unwrap();
    writer.write_nt_headers(NtHeaders {
        machine,
        time_date_stamp: 0,
        characteristics: pe::IMAGE_FILE_DLL | pe::IMAGE_FILE_EXECUTABLE_IMAGE,
        major_linker_version: 0,
        minor_linker_version: 0,
        address_of_entry_point: 0,
        image_base: 0x1_8000_0000,
        major_operating_system_version: 6,
        minor_operating_system_version: 0,
        major_image_version: 0,
        minor_image_version: 0,
        major_subsystem_version: 6,
        minor_subsystem_version: 0,
        subsystem: pe::IMAGE_SUBSYSTEM_WINDOWS_CUI,
        dll_characteristics: Default::default(),
        size_of_stack_reserve: 0,
        size_of_stack_commit: 0,
        size_of_heap_reserve: 0,
        size_of_heap_commit: 0,
    });
    writer.write_section_headers();
    writer.write_section(section.file_offset, &table(section.virtual_address));
    bytes
}

/// The export directory, its three tables, and the names, for an address `start`.
fn export_table(start: u32, functions: &[&str]) -> Vec<u8> {
    let count = functions.len() as u32;
    let (addresses, names) = (start + 40, start + 40 + 4 * count);
    let ordinals = names + 4 * count;
    let mut text_address = ordinals + 2 * count;
    let head = [0, 0, 0, text_address, 1, count, count, addresses, names, ordinals];
    let mut table: Vec<u8> = head.iter().flat_map(|number| number.to_le_bytes()).collect();
    // Somewhere outside of this table: inside, they would name functions of another library.
    table.extend(functions.iter().flat_map(|_| (start + 0x0010_0000).to_le_bytes()));
    for name in functions {
        table.extend(text_address.to_le_bytes());
        text_address += name.len() as u32 + 1;
    }
    table.extend((0..count as u16).flat_map(u16::to_le_bytes));
    table.extend(functions.iter().flat_map(|name| name.bytes().chain([0])));
    table
}

fn dylib(architecture: Architecture, functions: &[&str]) -> Vec<u8> {
    let mut object = Object::new(BinaryFormat::MachO, architecture, Endianness::Little);
    let text = object.section_id(StandardSection::Text);
    object.append_section_data(text, &[0xc3], 1);
    for name in functions {
        object.add_symbol(Symbol {
            name: name.as_bytes().to_vec(),
            value: 0,
            size: 0,
            kind: SymbolKind::Text,
            scope: SymbolScope::Dynamic,
            weak: false,
            section: SymbolSection::Section(text),
            flags: SymbolFlags::None,
        });
    }
    let mut bytes = object.write().unwrap();
    // The file type, after magic number and processor.
    bytes[12..16].copy_from_slice(&macho::MH_DYLIB.0.to_le_bytes());
    bytes
}
