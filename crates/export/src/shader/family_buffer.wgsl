@group(0) @binding(0) var<storage, read> student_t_tables: array<u32>;

// A word of the tables.
fn student_t_impl_word(at: u32) -> u32 {
    return student_t_tables[at];
}
