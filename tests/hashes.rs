//! The same bits for any number of threads and in every build: run this in debug and with `--release`.

use microfacet_bake::bake::bake;
use microfacet_bake::spec::{Quality, general_set};
use microfacet_sampler::{Precision, Table};

/// CRC-32 of the values of the default set's tables, in the order in which they are baked.
const DEFAULT: [u32; 5] = [173_765_269, 4_103_087_232, 3_882_653_611, 1_193_265_727, 764_049_282];

fn baked(threads: usize) -> Vec<Table> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| general_set(Quality::Default, Precision::F32).iter().map(bake).collect())
}

fn hash(table: &Table) -> u32 {
    let mut hasher = crc32fast::Hasher::new();
    table.values.iter().for_each(|value| hasher.update(&value.to_le_bytes()));
    hasher.finalize()
}

#[test]
fn the_default_tables_are_the_same_bits_for_any_number_of_threads() {
    for threads in [1, 2, 3, 8] {
        let hashes: Vec<u32> = baked(threads).iter().map(hash).collect();
        assert_eq!(
            hashes, DEFAULT,
            "{threads} threads; if numbers were meant to change, see tests/default_set.rs"
        );
    }
}
