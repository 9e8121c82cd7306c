//! The same bits for any number of threads and in every build: run this in debug and with
//! `--release`.

use microfacet_baker::bake::bake;
use microfacet_baker::progress::Stage;
use microfacet_baker::table_spec::{Quality, general_set};
use microfacet_sampler::Tables;
use microfacet_tables::{Precision, Table};

fn baked(threads: usize) -> Vec<Table> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| {
        general_set(Quality::Default, Precision::F32)
            .iter()
            .map(|spec| bake(spec, &Stage::unwatched()))
            .collect()
    })
}

#[test]
fn the_default_tables_are_the_same_bits_for_any_number_of_threads() {
    let committed = Tables::embedded();
    let bits = |table: &Table| -> Vec<u32> { table.values.iter().map(|x| x.to_bits()).collect() };
    for threads in [1, 2, 3, 8] {
        for table in baked(threads) {
            let same = committed.tables().iter().find(|other| other.name == table.name);
            let same = same.unwrap_or_else(|| panic!("no table {} in the set", table.name));
            assert!(
                bits(&table) == bits(same),
                "{}, {threads} threads; if numbers were meant to change, see tests/files/default_set.rs",
                table.name
            );
        }
    }
}
