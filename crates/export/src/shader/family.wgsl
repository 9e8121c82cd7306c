// ---- Tables of every gamma ----------------------------------------------------------------------
// student_t_family.h has the same in C, and the structures of what is read here: of a head whose
// offsets are in bytes, of weights between nodes of gamma, of numbers, and of codes of 16 bits.

// Where the head has its two parts, by falling gamma, and the albedos; and how long they are.
const STUDENT_T_IMPL_PARTS = 5u;
const STUDENT_T_IMPL_PART = 33u;
const STUDENT_T_IMPL_VOLUMES = 71u;
const STUDENT_T_IMPL_VOLUME = 28u;
// Words of the weights between two places of gamma.
const STUDENT_T_IMPL_BETWEEN = 53u;
// Rows of slopes whose codes have steps in common.
const STUDENT_T_IMPL_ROWS = 16u;

// The weights of four nodes of gamma, from the first on.
struct StudentTImplWindow {
    start: u32,
    weights: vec4f,
}

// The lobe of one gamma and roughness: what a shader makes at a hit, and hands to the functions.
struct StudentTLobe {
    sigma: vec2f,    // in [1e-8, 1e6]
    gamma: f32,      // at most 1e18
    is_mirror: bool, // a sigma was not above 0: the albedo is 1
    is_ggx: f32,     // 0: gamma = 2 is read from tables as any other
    s: f32,          // 1/(gamma - 1)
    d_s: f32,        // s and 1 - gamma/2 of D, where s is never 0; 1/2 less of the latter
    d_power: f32,
    kappa: f32,      // of the coordinate of masking, z/(z + kappa rho)
    heavy_exponent: f32,
    heavy_root_s: f32,
    masking_crowded: f32,
    masking_cells: f32,
    rows: f32,
    rows_first: f32,
    rows_second: f32,
    rows_second_end: f32,
    rows_third: f32,
    numbers: f32,
    along_scale: f32,
    across_scale: f32,
    heavy_per_row: f32,
    part: u32,       // where the head has what is common to its range of gamma
    slopes: StudentTImplWindow,
    across: StudentTImplWindow,
    masking: StudentTImplWindow,
}

fn student_t_impl_float(at: u32) -> f32 {
    return bitcast<f32>(student_t_impl_word(at));
}

fn student_t_impl_four(at: u32) -> vec4f {
    return vec4f(student_t_impl_float(at), student_t_impl_float(at + 1u),
                 student_t_impl_float(at + 2u), student_t_impl_float(at + 3u));
}

// The place of a table, of which the head has the offset in bytes.
fn student_t_impl_table(at: u32) -> u32 {
    return student_t_impl_word(at) >> 2u;
}

// Two codes of a word.
fn student_t_impl_codes(at: u32) -> vec2f {
    let word = student_t_impl_word(at);
    return vec2f(f32(word & 65535u), f32(word >> 16u));
}

fn student_t_impl_window(between: u32, table: u32, x: f32) -> StudentTImplWindow {
    let at = between + 5u + 16u * table;
    let low = student_t_impl_four(at) + x * student_t_impl_four(at + 4u);
    let high = student_t_impl_four(at + 8u) + x * student_t_impl_four(at + 12u);
    return StudentTImplWindow(student_t_impl_word(between + 2u + table), low + (x * x) * high);
}

// The lobe of a gamma in [1.501, infinity] and a roughness along x and along y. gamma and sigma are
// taken at the nearer end of their ranges. Infinity may be any number from 1e18 on.
fn student_t_lobe_at(gamma: f32, sigma: vec2f) -> StudentTLobe {
    let has_two = student_t_impl_word(4u) > 1u;
    let second = has_two && !(gamma >= student_t_impl_float(3u));
    let part = STUDENT_T_IMPL_PARTS + select(0u, STUDENT_T_IMPL_PART, second);
    let most = student_t_impl_min(student_t_impl_float(part + 1u), 1e18);
    let g = student_t_impl_min(student_t_impl_max(gamma, student_t_impl_float(part)), most);
    let less = g - 1.0;
    let twice = 2.0 * g - 3.0;
    let s = 1.0 / less;
    let exponent = 1.0 / twice;
    // The cell of gamma.
    let r = twice * s;
    let first = student_t_impl_float(part + 14u);
    let slot = student_t_impl_max((first - r) * student_t_impl_float(part + 15u), 0.0);
    var cell = student_t_impl_word(part + 17u);
    if slot < f32(student_t_impl_word(part + 16u)) {
        let at = u32(slot);
        let codes = student_t_impl_codes(student_t_impl_table(part + 18u) + (at >> 1u));
        cell = u32(select(codes.x, codes.y, (at & 1u) > 0u));
    }
    let between = student_t_impl_table(part + 19u) + STUDENT_T_IMPL_BETWEEN * cell;
    let x = (student_t_impl_float(between) - r) * student_t_impl_float(between + 1u);
    return StudentTLobe(
        vec2f(student_t_impl_sigma(sigma.x), student_t_impl_sigma(sigma.y)),
        g,
        !(sigma.x > 0.0 && sigma.y > 0.0),
        0.0,
        s,
        student_t_impl_max(s, 9.094947e-13), // 2^-40: Beckmann to rounding
        0.5 - 0.5 * student_t_impl_min(less, 1.0995116e12),
        student_t_impl_float(part + 2u) * (less * exponent),
        exponent,
        sqrt(s),
        f32(student_t_impl_word(part + 3u)),
        student_t_impl_float(part + 4u),
        student_t_impl_float(part + 5u),
        student_t_impl_float(part + 6u),
        student_t_impl_float(part + 7u),
        student_t_impl_float(part + 8u),
        student_t_impl_float(part + 9u),
        f32(student_t_impl_word(part + 10u)),
        student_t_impl_float(part + 11u),
        student_t_impl_float(part + 12u),
        student_t_impl_float(part + 13u),
        part,
        student_t_impl_window(between, 0u, x),
        student_t_impl_window(between, 1u, x),
        student_t_impl_window(between, 2u, x),
    );
}

// The sum of pairs of codes of four nodes of gamma, which are so many words apart.
fn student_t_impl_sum(at: u32, step: u32, w: vec4f) -> vec2f {
    return (w.x * student_t_impl_codes(at) + w.y * student_t_impl_codes(at + step))
        + (w.z * student_t_impl_codes(at + 2u * step) + w.w * student_t_impl_codes(at + 3u * step));
}

// Value and slope at a place of a table, of which the head has the offsets of codes and of their
// starts and steps, and with which gamma has so many nodes.
fn student_t_impl_node_of(
    table: u32,
    shapes: u32,
    window: StudentTImplWindow,
    place: u32,
) -> vec2f {
    let codes = student_t_impl_table(table) + place * shapes + window.start;
    let columns = student_t_impl_four(student_t_impl_table(table + 1u) + 4u * place);
    return columns.xz + columns.yw * student_t_impl_sum(codes, 1u, window.weights);
}

fn student_t_impl_cell_of(
    table: u32,
    shapes: u32,
    window: StudentTImplWindow,
    place: StudentTImplPlace,
) -> f32 {
    let a = student_t_impl_node_of(table, shapes, window, place.cell);
    let b = student_t_impl_node_of(table, shapes, window, place.cell + 1u);
    return student_t_impl_hermite(a, b, place.position);
}

// G1 over its coordinate and the number of cells.
fn student_t_impl_masking_at(lobe: StudentTLobe, place: StudentTImplPlace) -> f32 {
    let shapes = student_t_impl_word(lobe.part + 22u);
    return student_t_impl_cell_of(lobe.part + 27u, shapes, lobe.masking, place);
}

// g of the slope across.
fn student_t_impl_across_at(lobe: StudentTLobe, place: StudentTImplPlace) -> f32 {
    let shapes = student_t_impl_word(lobe.part + 21u);
    return student_t_impl_cell_of(lobe.part + 25u, shapes, lobe.across, place);
}

// Value and slope at a node of a row of slopes.
fn student_t_impl_slopes_of(lobe: StudentTLobe, row: u32, column: u32) -> vec2f {
    let numbers = 2u * u32(lobe.numbers);
    let shapes = student_t_impl_word(lobe.part + 20u);
    let at = student_t_impl_table(lobe.part + 23u) + (row * numbers + column) * shapes
        + lobe.slopes.start;
    let a = student_t_impl_codes(at);
    let b = student_t_impl_codes(at + 1u);
    let c = student_t_impl_codes(at + 2u);
    let d = student_t_impl_codes(at + 3u);
    let w = lobe.slopes.weights;
    let sum = (w.x * a + w.y * b) + (w.z * c + w.w * d);
    // Codes of tails are roots.
    let squares = (w.x * a.x * a.x + w.y * b.x * b.x) + (w.z * c.x * c.x + w.w * d.x * d.x);
    let steps = student_t_impl_table(lobe.part + 24u)
        + 5u * (row / STUDENT_T_IMPL_ROWS * (numbers + 1u) + column);
    let along = student_t_impl_four(steps);
    let value = along.x + along.y * sum.x + along.z * squares;
    return vec2f(value, along.w + student_t_impl_float(steps + 4u) * sum.y);
}

// g of the slope in the plane, at a view among the rows and a number among the nodes of the first
// or second half: linear between the views, a cubic through values and slopes along the number.
fn student_t_impl_along_at(
    lobe: StudentTLobe,
    view: StudentTImplPlace,
    second: u32,
    number: StudentTImplPlace,
) -> f32 {
    let column = second * u32(lobe.numbers) + number.cell;
    let next = min(view.cell + 1u, u32(lobe.rows)); // no row follows the last
    var a = student_t_impl_slopes_of(lobe, view.cell, column);
    var b = student_t_impl_slopes_of(lobe, view.cell, column + 1u);
    a += view.position * (student_t_impl_slopes_of(lobe, next, column) - a);
    b += view.position * (student_t_impl_slopes_of(lobe, next, column + 1u) - b);
    // Weights below 0 may take slopes out of the range in which the cubic ascends.
    let most = student_t_impl_max(3.0 * (b.x - a.x), 0.0);
    a = vec2f(student_t_impl_max(a.x, 0.0), student_t_impl_min(student_t_impl_max(a.y, 0.0), most));
    b = vec2f(student_t_impl_max(b.x, 0.0), student_t_impl_min(student_t_impl_max(b.y, 0.0), most));
    return student_t_impl_hermite(a, b, number.position);
}

// The share of visible normals that is in no table, at a view's place, and the rest.
fn student_t_impl_share_at(lobe: StudentTLobe, place: StudentTImplPlace) -> vec2f {
    let start = lobe.masking.start;
    let factors = student_t_impl_four(student_t_impl_table(lobe.part + 31u) + start);
    let w = lobe.masking.weights * factors;
    let all = (w.x + w.y) + (w.z + w.w);
    let shapes = student_t_impl_word(lobe.part + 22u);
    let codes = student_t_impl_table(lobe.part + 29u) + 2u * (place.cell * shapes + start);
    let columns = student_t_impl_table(lobe.part + 30u) + 8u * place.cell;
    let low = student_t_impl_four(columns);
    let high = student_t_impl_four(columns + 4u);
    let a = low.xz * all + low.yw * student_t_impl_sum(codes, 2u, w);
    let b = high.xz * all + high.yw * student_t_impl_sum(codes + 1u, 2u, w);
    let x = place.position;
    let area = (a.x + x * a.y) + (x * x) * (b.x + x * b.y);
    let rest = student_t_impl_max(area, STUDENT_T_IMPL_SMALLEST);
    let c = student_t_impl_four(student_t_impl_table(lobe.part + 32u) + 4u * place.cell);
    let heavy = student_t_impl_max((c.x + x * c.y) + (x * x) * (c.z + x * c.w), 0.0);
    return vec2f(heavy, rest) / (heavy + rest);
}
