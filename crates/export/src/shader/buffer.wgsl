@group(0) @binding(0) var<storage, read> student_t_tables: array<vec2f>;

// A pair of numbers of the tables.
fn student_t_impl_pair(at: u32) -> vec2f {
    return student_t_tables[at];
}
