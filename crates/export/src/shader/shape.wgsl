// ---- Tables of shapes ---------------------------------------------------------------------------

// The cubic of a cell, from the coefficients of a table.
fn student_t_impl_cubic(table: u32, place: StudentTImplPlace) -> f32 {
    let a = student_t_impl_pair(table + 2u * place.cell);
    let b = student_t_impl_pair(table + 2u * place.cell + 1u);
    let w = place.position;
    return (a.x + w * a.y) + (w * w) * (b.x + w * b.y);
}

// G1 over its coordinate and the number of cells.
fn student_t_impl_masking_at(lobe: StudentTLobe, place: StudentTImplPlace) -> f32 {
    return student_t_impl_cubic(lobe.masking, place);
}

// g of the slope across.
fn student_t_impl_across_at(lobe: StudentTLobe, place: StudentTImplPlace) -> f32 {
    return student_t_impl_cubic(lobe.across, place);
}

// g of the slope in the plane, at a view among the rows and a number among the nodes of the first
// or second half: linear between the views, a cubic through values and slopes along the number.
fn student_t_impl_along_at(
    lobe: StudentTLobe,
    view: StudentTImplPlace,
    second: u32,
    number: StudentTImplPlace,
) -> f32 {
    let numbers = u32(lobe.numbers);
    let low = lobe.slopes + (2u * view.cell + second) * numbers + number.cell;
    let high = low + 2u * numbers;
    var a = student_t_impl_pair(low);
    var b = student_t_impl_pair(low + 1u);
    a += view.position * (student_t_impl_pair(high) - a);
    b += view.position * (student_t_impl_pair(high + 1u) - b);
    return student_t_impl_hermite(a, b, number.position);
}

// The share of visible normals that is in no table, at a view's place, and the rest.
fn student_t_impl_share_at(lobe: StudentTLobe, place: StudentTImplPlace) -> vec2f {
    let share = student_t_impl_cubic(lobe.heavy, place);
    return vec2f(share, 1.0 - share);
}
