@group(0) @binding(0) var student_t_tables: texture_2d<u32>;

// A word of the tables: the channel of a texel. Rows have 512.
fn student_t_impl_word(at: u32) -> u32 {
    return textureLoad(student_t_tables, vec2i(i32(at & 511u), i32(at >> 9u)), 0).x;
}
