//! The tables of shapes for shaders: one list of pairs of numbers, as a buffer and as an image, and
//! a description of where each table is.

use std::collections::BTreeMap;

use microfacet_tables::crc32;
use serde::Serialize;

use super::super::family::Block;
use super::super::members::{Member, PREFIXES, Part, Value};
use super::super::numbers::as_typed;
use super::super::{ExportFile, Family, Shape, c, open_exr};
use super::Kind;

/// Raised whenever the order of members or tables changes.
pub(super) const LAYOUT: u32 = 2;

/// Pairs in a row of the image.
pub const WIDTH: usize = 512;

/// The content of `student_t.json`.
#[derive(Serialize)]
struct Description<'a> {
    layout: u32,
    generator: &'a str,
    numerics: u32,
    file: String,
    image: String,
    format: &'static str,
    byte_order: &'static str,
    width: usize,
    height: usize,
    shapes: BTreeMap<String, Entry>,
    /// The CRC-32 (ISO-HDLC) of all files that were written with this one.
    crc32: BTreeMap<String, String>,
}

/// One shape; offsets and lengths are in pairs.
#[derive(Serialize)]
struct Entry {
    offset: usize,
    length: usize,
    members: Vec<Named>,
    tables: BTreeMap<String, Place>,
    errors: Errors,
    /// Forms of masking whose albedos are those of the default set.
    albedos_of_default_set: Vec<&'static str>,
}

/// A member of the shape's description; pair i holds the members 2i and 2i + 1.
#[derive(Serialize)]
struct Named {
    name: String,
    value: f32,
}

/// Where a table is in its shape; each row of `columns` numbers is padded to pairs.
#[derive(Serialize)]
struct Place {
    offset: usize,
    rows: usize,
    columns: usize,
}

/// The largest errors of the tables against the model.
#[derive(Serialize)]
struct Errors {
    g1: Option<f64>,
    cdf_along: Option<f64>,
    cdf_across: Option<f64>,
    albedo: Option<f64>,
    albedo_elsewhere: Option<f64>,
    average: f64,
}

/// Adds data and description of all shapes to the files of functions; the description comes last,
/// since it has the checksums of the others.
pub(super) fn append_files(shapes: &[Shape], files: &mut Vec<ExportFile>) {
    let mut pairs = Vec::new();
    let entry = |shape: &Shape| (as_typed(shape.gamma), append(shape, |_| true, &mut pairs));
    let entries = shapes.iter().map(entry).collect();
    let height = pairs.len().div_ceil(WIDTH);
    pairs.resize(WIDTH * height, [0.0; 2]);
    let first = shapes.first().expect("shapes");
    let bytes: Vec<u8> = pairs.as_flattened().iter().flat_map(|x| x.to_le_bytes()).collect();
    let planes = [0, 1].map(|i| pairs.iter().map(|pair| pair[i]).collect());
    let name = Kind::Shapes.name();
    let image = open_exr(name, [WIDTH, height], planes.into(), false, None);
    let [file, image_file] = ["bin", "exr"].map(|end| format!("{name}.{end}"));
    files.push(ExportFile::new(&*file, bytes));
    files.push(ExportFile::new(&*image_file, image.expect("finite numbers")));
    let description = Description {
        layout: LAYOUT,
        generator: &first.generator,
        numerics: first.numerics,
        file,
        image: image_file,
        format: "rg32f",
        byte_order: "little",
        width: WIDTH,
        height,
        shapes: entries,
        crc32: files.iter().map(checksum).collect(),
    };
    let json = serde_json::to_string_pretty(&description).expect("names and finite numbers");
    files.push(ExportFile::new(format!("{name}.json"), json + "\n"));
}

/// The content of `student_t_family.json`.
#[derive(Serialize)]
struct FamilyDescription<'a> {
    /// That of the block, which C reads as well.
    layout: u32,
    generator: &'a str,
    numerics: u32,
    file: String,
    format: &'static str,
    byte_order: &'static str,
    width: usize,
    height: usize,
    crc32: BTreeMap<String, String>,
}

/// Adds the block of a family, filled up to whole rows of a texture, and its description.
pub(super) fn append_family(family: &Family, files: &mut Vec<ExportFile>) {
    let mut bytes = Block::new(family, c::LAYOUT).bytes();
    let row = 4 * WIDTH;
    let height = bytes.len().div_ceil(row);
    bytes.resize(row * height, 0);
    let name = Kind::Family.name();
    let file = format!("{name}.bin");
    files.push(ExportFile::new(&*file, bytes));
    let description = FamilyDescription {
        layout: c::LAYOUT,
        generator: &family.generator,
        numerics: family.numerics,
        file,
        format: "r32uint",
        byte_order: "little",
        width: WIDTH,
        height,
        crc32: files.iter().map(checksum).collect(),
    };
    let json = serde_json::to_string_pretty(&description).expect("names and numbers");
    files.push(ExportFile::new(format!("{name}.json"), json + "\n"));
}

/// A file's name and the CRC-32 of its bytes.
fn checksum(file: &ExportFile) -> (String, String) {
    (file.name.clone(), crc32(&file.contents))
}

/// Rows of the texture of these shapes; WebGL 2 guarantees no more than 2048.
pub fn texture_rows(shapes: &[Shape]) -> usize {
    let mut pairs = Vec::new();
    for shape in shapes {
        append(shape, |_| true, &mut pairs);
    }
    pairs.len().div_ceil(WIDTH)
}

/// Appends a shape with some of its tables, by name, and returns the index of its first pair.
/// Functions that read a table that is left out must not be called.
pub fn append_some(
    shape: &Shape,
    is_kept: impl Fn(&str) -> bool,
    pairs: &mut Vec<[f32; 2]>,
) -> usize {
    append(shape, is_kept, pairs).offset
}

/// Appends a shape: its members, then the tables that are kept.
fn append(shape: &Shape, is_kept: impl Fn(&str) -> bool, pairs: &mut Vec<[f32; 2]>) -> Entry {
    let offset = pairs.len();
    let lists = shape.lists();
    let mut at = lists.iter().map(|list| list.len().div_ceil(2)).sum::<usize>();
    let parts: Vec<Part> = shape.parts().into_iter().filter(|part| is_kept(&part.name)).collect();
    let mut tables = BTreeMap::new();
    for part in &parts {
        let (rows, columns) = (part.values.len() / part.columns, part.columns);
        tables.insert(part.name.clone(), Place { offset: at, rows, columns });
        at += rows * columns.div_ceil(2);
    }

    let mut named = Vec::new();
    for (prefix, list) in PREFIXES.into_iter().zip(lists) {
        let numbers: Vec<f32> = list.iter().map(|member| number(&member.value, &tables)).collect();
        pairs.extend(numbers.chunks(2).map(pair));
        let names = list.into_iter().map(|Member { name, .. }| format!("{prefix}{name}"));
        named.extend(names.zip(numbers).map(|(name, value)| Named { name, value }));
    }
    for Part { values, columns, .. } in parts {
        pairs.extend(values.chunks(columns).flat_map(|row| row.chunks(2).map(pair)));
    }
    assert_eq!(pairs.len(), offset + at, "every table is where its member says");
    assert!(at < 1 << f32::MANTISSA_DIGITS, "places are counted in single precision");
    let [cdf_along, cdf_across] = shape.errors.cdf;
    let errors = Errors {
        g1: shape.errors.g1,
        cdf_along,
        cdf_across,
        albedo: shape.worst_albedo(|table| table.errors[0]),
        albedo_elsewhere: shape.worst_albedo(|table| table.errors[1]),
        average: shape.worst_albedo(|table| Some(table.average_error)).unwrap_or_default(),
    };
    let albedos_of_default_set = shape.from_default.iter().map(|masking| masking.name()).collect();
    Entry { offset, length: at, members: named, tables, errors, albedos_of_default_set }
}

/// A member as a number; of a table its offset in the shape, which is exact in single precision, or
/// 0 if it is left out.
fn number(value: &Value, tables: &BTreeMap<String, Place>) -> f32 {
    match value {
        Value::Table(Some(name)) => tables.get(name).map_or(0.0, |place| place.offset as f32),
        _ => value.number().unwrap_or(0.0),
    }
}

fn pair(numbers: &[f32]) -> [f32; 2] {
    [numbers[0], numbers.get(1).copied().unwrap_or_default()]
}
