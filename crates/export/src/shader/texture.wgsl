@group(0) @binding(0) var student_t_tables: texture_2d<f32>;

// A pair of numbers of the tables: the first two channels of a texel. Rows have 512.
fn student_t_impl_pair(at: u32) -> vec2f {
    return textureLoad(student_t_tables, vec2i(i32(at & 511u), i32(at >> 9u)), 0).xy;
}
