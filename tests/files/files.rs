//! Damaged images: any truncation or flipped bit of a small table gives an error or the same table.

use std::io::Cursor;

use exr::prelude::*;
use microfacet_baker::bake::bake;
use microfacet_baker::plan::Plan;
use microfacet_baker::progress::Stage;
use microfacet_baker::store::{decode_exr, encode_exr};
use microfacet_baker::table_spec::{ShapeAxis, TableSpec};
use microfacet_sampler::Tables;
use microfacet_tables::{Kind, LoadError, Precision};

fn small_table(precision: Precision) -> Tables {
    let spec = TableSpec {
        name: "shadowing".into(),
        kind: Kind::Shadowing,
        shapes: ShapeAxis::points([0.5, 1.0]),
        covers: [0.5, 1.0],
        views: 4,
        numbers: 0,
        precision,
    };
    let mut origin = Plan::default().provenance();
    origin.conventions.clear();
    Tables::from_tables(origin, vec![bake(&spec, &Stage::unwatched())]).unwrap()
}

fn small_image() -> (Tables, Vec<u8>) {
    let set = small_table(Precision::F16);
    let bytes = encode_exr(set.provenance(), set.tables()).unwrap();
    assert_eq!(decode_exr(&bytes).unwrap(), set);
    (set, bytes)
}

#[test]
fn every_truncation_of_an_image_is_refused() {
    let (_, file) = small_image();
    for length in 0..file.len() {
        let read = decode_exr(&file[..length]);
        assert!(matches!(read, Err(LoadError::Invalid(_))), "{length} bytes");
    }
}

#[test]
fn every_flipped_bit_of_an_image_is_refused_or_harmless() {
    let (set, mut file) = small_image();
    let mut harmless = 0;
    for bit in 0..8 * file.len() {
        file[bit / 8] ^= 1 << (bit % 8);
        if let Ok(read) = decode_exr(&file) {
            assert_eq!(read, set, "bit {bit}");
            harmless += 1;
        }
        file[bit / 8] ^= 1 << (bit % 8);
    }
    // Attributes that say how to display an image are not part of the table.
    assert!(harmless < 8 * file.len() / 4, "{harmless} of {}", 8 * file.len());
}

/// A list that repeats a channel could take any amount of memory.
#[test]
fn a_channel_named_twice_is_refused() {
    let (_, mut file) = small_image();
    let (list, lie) = (br#"["value","slope"]"#, br#"["Y","Y","slope"]"#);
    let at = file.windows(list.len()).position(|bytes| bytes == list).unwrap();
    file[at..at + lie.len()].copy_from_slice(lie);
    let message = decode_exr(&file).unwrap_err().to_string();
    assert!(message.contains("not those of the description"), "{message}");
}

/// A table of a measured file has the file's name, in any script.
#[test]
fn an_image_of_any_name_is_read_back() {
    let set = small_table(Precision::F32);
    let mut table = set.tables()[0].clone();
    table.name = "é м漢🎨".into();
    let bytes = encode_exr(set.provenance(), &[table.clone()]).unwrap();
    assert_eq!(decode_exr(&bytes).unwrap().tables(), [table]);
}

/// The result for an image that another program has read, changed and written.
fn written_anew(
    file: &[u8],
    change: &dyn Fn(&mut FlatImage),
) -> std::result::Result<Tables, LoadError> {
    let mut image = read()
        .no_deep_data()
        .largest_resolution_level()
        .all_channels()
        .all_layers()
        .all_attributes()
        .from_buffered(Cursor::new(file))
        .unwrap();
    change(&mut image);
    let mut file = Cursor::new(Vec::new());
    image.write().to_buffered(&mut file).unwrap();
    decode_exr(&file.into_inner())
}

/// An image that the writer would not write is refused undecoded, even with the same pixels.
#[test]
fn an_image_written_anew_by_another_program_is_refused() {
    let (set, file) = small_image();
    assert_eq!(written_anew(&file, &|_| ()).unwrap(), set);
    let refused = |part: &str, change: &dyn Fn(&mut FlatImage)| {
        let why = written_anew(&file, change).unwrap_err().to_string();
        assert!(why.contains(&format!("OpenEXR: {part}")), "{why}");
    };
    for (compression, name) in [
        (Compression::Uncompressed, "no"),
        (Compression::RLE, "rle"),
        (Compression::ZIP1, "zip line"),
        (Compression::PIZ, "piz"),
        (Compression::PXR24, "pxr24"),
        (Compression::B44, "b44"),
        (Compression::B44A, "b44a"),
    ] {
        let name = format!("{name} compression, and");
        refused(&name, &|image| image.layer_data[0].encoding.compression = compression);
    }
    refused("tiles", &|image| {
        image.layer_data[0].encoding.blocks = Blocks::Tiles(Vec2(16, 16));
    });
    refused("integers", &|image| {
        let samples = &mut image.layer_data[0].channel_data.list[0].sample_data;
        *samples = FlatSamples::U32(vec![0; samples.len()]);
    });
    refused("2 parts of 1 tables", &|image| {
        let mut part = image.layer_data[0].clone();
        part.attributes.layer_name = Some("other".into());
        image.layer_data.push(part);
    });
}

/// The parts of an image are the tables in their order, with their names.
#[test]
fn parts_that_are_exchanged_renamed_or_missing_are_refused() {
    let set = small_table(Precision::F32);
    let table = |name: &str, change: f32| {
        let mut table = set.tables()[0].clone();
        table.name = name.into();
        table.values.iter_mut().for_each(|x| *x *= change);
        table
    };
    let tables = [table("one", 1.0), table("two", 0.5), table("three", 0.25)];
    let file = encode_exr(set.provenance(), &tables).unwrap();
    assert_eq!(decode_exr(&file).unwrap().tables(), tables);
    assert_eq!(written_anew(&file, &|_| ()).unwrap().tables(), tables);
    let refused = |part: &str, change: &dyn Fn(&mut FlatImage)| {
        let why = written_anew(&file, change).unwrap_err().to_string();
        assert!(why.contains(part), "{why}");
    };
    refused("a part named `three` in the place of the table `two`", &|image| {
        image.layer_data.swap(1, 2);
    });
    refused("a part named `four`", &|image| {
        image.layer_data[1].attributes.layer_name = Some("four".into());
    });
    refused("2 parts of 3 tables", &|image| {
        image.layer_data.pop();
    });
    refused("checksum", &|image| {
        let (one, two) = image.layer_data.split_at_mut(2);
        std::mem::swap(&mut one[1].channel_data, &mut two[0].channel_data);
    });
}
