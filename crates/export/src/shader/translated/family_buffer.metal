#ifndef STUDENT_T
#define STUDENT_T

#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;


struct StudentTImplWindow {
    uint start;
    char _pad1[12];
    metal::float4 weights;
};
struct StudentTLobe {
    metal::float2 sigma;
    float gamma;
    bool is_mirror;
    char _pad3[3];
    float is_ggx;
    float s;
    float d_s;
    float d_power;
    float kappa;
    float heavy_exponent;
    float heavy_root_s;
    float masking_crowded;
    float masking_cells;
    float rows;
    float rows_first;
    float rows_second;
    float rows_second_end;
    float rows_third;
    float numbers;
    float along_scale;
    float across_scale;
    float heavy_per_row;
    uint part;
    char _pad22[4];
    StudentTImplWindow slopes;
    StudentTImplWindow across;
    StudentTImplWindow masking;
};
struct StudentTImplPlace {
    uint cell;
    float position;
};
struct StudentTImplThree {
    uint start;
    char _pad1[12];
    metal::float3 weights;
};
struct StudentTImplAlbedo {
    uint volume;
    float sigma;
    float less;
    float coordinate;
    StudentTImplThree by_shape;
    StudentTImplThree by_sigma;
};
struct StudentTImplViews {
    uint cell;
    char _pad1[12];
    metal::float4 weights;
};
struct StudentTImplDirection {
    metal::float2 xy;
    float frame;
    float rho;
    float z;
    float square;
};
struct StudentTImplHalfSlope {
    float x;
    float z;
    float sign;
    float shrink;
    float clear;
};
constant uint STUDENT_T_IMPL_PARTS = 5u;
constant uint STUDENT_T_IMPL_PART = 33u;
constant uint STUDENT_T_IMPL_VOLUMES = 71u;
constant uint STUDENT_T_IMPL_VOLUME = 28u;
constant uint STUDENT_T_IMPL_BETWEEN = 53u;
constant uint STUDENT_T_IMPL_ROWS = 16u;
constant uint STUDENT_T_IMPL_SHAPES = 37u;
constant uint STUDENT_T_IMPL_VIEWS = 29u;
constant uint STUDENT_T_UNCORRELATED = 0u;
constant uint STUDENT_T_HEIGHT_CORRELATED = 1u;

inline uint student_t_impl_word(
    uint at,
    device const uint* student_t_tables
) {
    uint _e3 = student_t_tables[at];
    return _e3;
}

inline float student_t_impl_float(
    uint at_1,
    device const uint* student_t_tables
) {
    uint _e1 = student_t_impl_word(at_1, student_t_tables);
    return as_type<float>(_e1);
}

inline metal::float4 student_t_impl_four(
    uint at_2,
    device const uint* student_t_tables
) {
    float _e1 = student_t_impl_float(at_2, student_t_tables);
    float _e4 = student_t_impl_float(at_2 + 1u, student_t_tables);
    float _e7 = student_t_impl_float(at_2 + 2u, student_t_tables);
    float _e10 = student_t_impl_float(at_2 + 3u, student_t_tables);
    return metal::float4(_e1, _e4, _e7, _e10);
}

inline uint student_t_impl_table(
    uint at_3,
    device const uint* student_t_tables
) {
    uint _e1 = student_t_impl_word(at_3, student_t_tables);
    return _e1 >> 2u;
}

inline metal::float2 student_t_impl_codes(
    uint at_4,
    device const uint* student_t_tables
) {
    uint _e1 = student_t_impl_word(at_4, student_t_tables);
    return metal::float2(static_cast<float>(_e1 & 65535u), static_cast<float>(_e1 >> 16u));
}

inline StudentTImplWindow student_t_impl_window(
    uint between,
    uint table,
    float x,
    device const uint* student_t_tables
) {
    uint at_9 = (between + 5u) + (16u * table);
    metal::float4 _e8 = student_t_impl_four(at_9, student_t_tables);
    metal::float4 _e11 = student_t_impl_four(at_9 + 4u, student_t_tables);
    metal::float4 low = _e8 + (x * _e11);
    metal::float4 _e16 = student_t_impl_four(at_9 + 8u, student_t_tables);
    metal::float4 _e19 = student_t_impl_four(at_9 + 12u, student_t_tables);
    metal::float4 high = _e16 + (x * _e19);
    uint _e25 = student_t_impl_word((between + 2u) + table, student_t_tables);
    return StudentTImplWindow {_e25, {}, low + ((x * x) * high)};
}

inline float student_t_impl_min(
    float a,
    float b
) {
    return (a < b) ? a : b;
}

inline float student_t_impl_max(
    float a_1,
    float b_1
) {
    return (a_1 > b_1) ? a_1 : b_1;
}

inline float student_t_impl_sigma(
    float sigma
) {
    float _e2 = student_t_impl_max(sigma, 0.00000001);
    float _e4 = student_t_impl_min(_e2, 1000000.0);
    return _e4;
}

inline uint student_t_impl_f2u32(float value) {
    return static_cast<uint>(metal::clamp(value, 0.0, 4294967000.0));
}

inline StudentTLobe student_t_lobe_at(
    float gamma,
    metal::float2 sigma_1,
    device const uint* student_t_tables
) {
    bool local = {};
    uint cell = {};
    bool local_1 = {};
    uint _e3 = student_t_impl_word(4u, student_t_tables);
    bool has_two = _e3 > 1u;
    if (has_two) {
        float _e9 = student_t_impl_float(3u, student_t_tables);
        local = !((gamma >= _e9));
    } else {
        local = false;
    }
    bool second_1 = local;
    uint part = STUDENT_T_IMPL_PARTS + (second_1 ? STUDENT_T_IMPL_PART : 0u);
    float _e21 = student_t_impl_float(part + 1u, student_t_tables);
    float _e23 = student_t_impl_min(_e21, 1000000000000000000.0);
    float _e24 = student_t_impl_float(part, student_t_tables);
    float _e25 = student_t_impl_max(gamma, _e24);
    float _e26 = student_t_impl_min(_e25, _e23);
    float less = _e26 - 1.0;
    float twice = (2.0 * _e26) - 3.0;
    float s_1 = 1.0 / less;
    float exponent = 1.0 / twice;
    float r = twice * s_1;
    float _e40 = student_t_impl_float(part + 14u, student_t_tables);
    float _e44 = student_t_impl_float(part + 15u, student_t_tables);
    float _e47 = student_t_impl_max((_e40 - r) * _e44, 0.0);
    uint _e50 = student_t_impl_word(part + 17u, student_t_tables);
    cell = _e50;
    uint _e54 = student_t_impl_word(part + 16u, student_t_tables);
    if (_e47 < static_cast<float>(_e54)) {
        uint at_10 = student_t_impl_f2u32(_e47);
        uint _e60 = student_t_impl_table(part + 18u, student_t_tables);
        metal::float2 _e64 = student_t_impl_codes(_e60 + (at_10 >> 1u), student_t_tables);
        cell = student_t_impl_f2u32(((at_10 & 1u) > 0u) ? _e64.y : _e64.x);
    }
    uint _e75 = student_t_impl_table(part + 19u, student_t_tables);
    uint _e77 = cell;
    uint between_1 = _e75 + (STUDENT_T_IMPL_BETWEEN * _e77);
    float _e80 = student_t_impl_float(between_1, student_t_tables);
    float _e84 = student_t_impl_float(between_1 + 1u, student_t_tables);
    float x_9 = (_e80 - r) * _e84;
    float _e87 = student_t_impl_sigma(sigma_1.x);
    float _e89 = student_t_impl_sigma(sigma_1.y);
    if (sigma_1.x > 0.0) {
        local_1 = sigma_1.y > 0.0;
    } else {
        local_1 = false;
    }
    bool _e100 = local_1;
    float _e103 = student_t_impl_max(s_1, 0.0000000000009094947);
    float _e105 = student_t_impl_min(less, 1099511600000.0);
    float _e112 = student_t_impl_float(part + 2u, student_t_tables);
    uint _e118 = student_t_impl_word(part + 3u, student_t_tables);
    float _e122 = student_t_impl_float(part + 4u, student_t_tables);
    float _e125 = student_t_impl_float(part + 5u, student_t_tables);
    float _e128 = student_t_impl_float(part + 6u, student_t_tables);
    float _e131 = student_t_impl_float(part + 7u, student_t_tables);
    float _e134 = student_t_impl_float(part + 8u, student_t_tables);
    float _e137 = student_t_impl_float(part + 9u, student_t_tables);
    uint _e140 = student_t_impl_word(part + 10u, student_t_tables);
    float _e144 = student_t_impl_float(part + 11u, student_t_tables);
    float _e147 = student_t_impl_float(part + 12u, student_t_tables);
    float _e150 = student_t_impl_float(part + 13u, student_t_tables);
    StudentTImplWindow _e152 = student_t_impl_window(between_1, 0u, x_9, student_t_tables);
    StudentTImplWindow _e154 = student_t_impl_window(between_1, 1u, x_9, student_t_tables);
    StudentTImplWindow _e156 = student_t_impl_window(between_1, 2u, x_9, student_t_tables);
    return StudentTLobe {metal::float2(_e87, _e89), _e26, !(_e100), {}, 0.0, s_1, _e103, 0.5 - (0.5 * _e105), _e112 * (less * exponent), exponent, metal::sqrt(s_1), static_cast<float>(_e118), _e122, _e125, _e128, _e131, _e134, _e137, static_cast<float>(_e140), _e144, _e147, _e150, part, {}, _e152, _e154, _e156};
}

inline metal::float2 student_t_impl_sum(
    uint at_5,
    uint step,
    metal::float4 w,
    device const uint* student_t_tables
) {
    metal::float2 _e4 = student_t_impl_codes(at_5, student_t_tables);
    metal::float2 _e8 = student_t_impl_codes(at_5 + step, student_t_tables);
    metal::float2 _e15 = student_t_impl_codes(at_5 + (2u * step), student_t_tables);
    metal::float2 _e21 = student_t_impl_codes(at_5 + (3u * step), student_t_tables);
    return ((w.x * _e4) + (w.y * _e8)) + ((w.z * _e15) + (w.w * _e21));
}

inline metal::float2 student_t_impl_node_of(
    uint table_1,
    uint shapes,
    StudentTImplWindow window,
    uint place,
    device const uint* student_t_tables
) {
    uint _e4 = student_t_impl_table(table_1, student_t_tables);
    uint codes = (_e4 + (place * shapes)) + window.start;
    uint _e11 = student_t_impl_table(table_1 + 1u, student_t_tables);
    metal::float4 _e15 = student_t_impl_four(_e11 + (4u * place), student_t_tables);
    metal::float2 _e20 = student_t_impl_sum(codes, 1u, window.weights, student_t_tables);
    return _e15.xz + (_e15.yw * _e20);
}

inline float student_t_impl_hermite(
    metal::float2 a_2,
    metal::float2 b_2,
    float w_1
) {
    float value_a = 1.0 + (w_1 * (w_1 * ((w_1 * 2.0) - 3.0)));
    float slope_a = w_1 * (1.0 + (w_1 * (w_1 - 2.0)));
    float value_b = w_1 * (w_1 * (3.0 - (w_1 * 2.0)));
    float slope_b = w_1 * (w_1 * (w_1 - 1.0));
    return ((a_2.x * value_a) + (b_2.x * value_b)) + ((a_2.y * slope_a) + (b_2.y * slope_b));
}

inline float student_t_impl_cell_of(
    uint table_2,
    uint shapes_1,
    StudentTImplWindow window_1,
    StudentTImplPlace place_1,
    device const uint* student_t_tables
) {
    metal::float2 _e5 = student_t_impl_node_of(table_2, shapes_1, window_1, place_1.cell, student_t_tables);
    metal::float2 _e9 = student_t_impl_node_of(table_2, shapes_1, window_1, place_1.cell + 1u, student_t_tables);
    float _e11 = student_t_impl_hermite(_e5, _e9, place_1.position);
    return _e11;
}

inline float student_t_impl_masking_at(
    StudentTLobe lobe,
    StudentTImplPlace place_2,
    device const uint* student_t_tables
) {
    uint _e5 = student_t_impl_word(lobe.part + 22u, student_t_tables);
    float _e10 = student_t_impl_cell_of(lobe.part + 27u, _e5, lobe.masking, place_2, student_t_tables);
    return _e10;
}

inline float student_t_impl_across_at(
    StudentTLobe lobe_1,
    StudentTImplPlace place_3,
    device const uint* student_t_tables
) {
    uint _e5 = student_t_impl_word(lobe_1.part + 21u, student_t_tables);
    float _e10 = student_t_impl_cell_of(lobe_1.part + 25u, _e5, lobe_1.across, place_3, student_t_tables);
    return _e10;
}

inline uint student_t_impl_div(uint lhs, uint rhs) {
    return lhs / metal::select(rhs, 1u, rhs == 0u);
}

inline metal::float2 student_t_impl_slopes_of(
    StudentTLobe lobe_2,
    uint row,
    uint column,
    device const uint* student_t_tables
) {
    uint numbers = 2u * student_t_impl_f2u32(lobe_2.numbers);
    uint _e10 = student_t_impl_word(lobe_2.part + 20u, student_t_tables);
    uint _e14 = student_t_impl_table(lobe_2.part + 23u, student_t_tables);
    uint at_11 = (_e14 + (((row * numbers) + column) * _e10)) + lobe_2.slopes.start;
    metal::float2 _e22 = student_t_impl_codes(at_11, student_t_tables);
    metal::float2 _e25 = student_t_impl_codes(at_11 + 1u, student_t_tables);
    metal::float2 _e28 = student_t_impl_codes(at_11 + 2u, student_t_tables);
    metal::float2 _e31 = student_t_impl_codes(at_11 + 3u, student_t_tables);
    metal::float4 w_6 = lobe_2.slopes.weights;
    metal::float2 sum_3 = ((lobe_2.slopes.weights.x * _e22) + (lobe_2.slopes.weights.y * _e25)) + ((lobe_2.slopes.weights.z * _e28) + (lobe_2.slopes.weights.w * _e31));
    float squares = (((lobe_2.slopes.weights.x * _e22.x) * _e22.x) + ((lobe_2.slopes.weights.y * _e25.x) * _e25.x)) + (((lobe_2.slopes.weights.z * _e28.x) * _e28.x) + ((lobe_2.slopes.weights.w * _e31.x) * _e31.x));
    uint _e71 = student_t_impl_table(lobe_2.part + 24u, student_t_tables);
    uint steps = _e71 + (5u * ((student_t_impl_div(row, STUDENT_T_IMPL_ROWS) * (numbers + 1u)) + column));
    metal::float4 _e81 = student_t_impl_four(steps, student_t_tables);
    float value = (_e81.x + (_e81.y * sum_3.x)) + (_e81.z * squares);
    float _e93 = student_t_impl_float(steps + 4u, student_t_tables);
    return metal::float2(value, _e81.w + (_e93 * sum_3.y));
}

inline float student_t_impl_along_at(
    StudentTLobe lobe_3,
    StudentTImplPlace view,
    uint second,
    StudentTImplPlace number,
    device const uint* student_t_tables
) {
    metal::float2 a_3 = {};
    metal::float2 b_3 = {};
    uint column_1 = (second * student_t_impl_f2u32(lobe_3.numbers)) + number.cell;
    uint next = metal::min(view.cell + 1u, student_t_impl_f2u32(lobe_3.rows));
    metal::float2 _e16 = student_t_impl_slopes_of(lobe_3, view.cell, column_1, student_t_tables);
    a_3 = _e16;
    metal::float2 _e21 = student_t_impl_slopes_of(lobe_3, view.cell, column_1 + 1u, student_t_tables);
    b_3 = _e21;
    metal::float2 _e23 = a_3;
    metal::float2 _e25 = student_t_impl_slopes_of(lobe_3, next, column_1, student_t_tables);
    metal::float2 _e26 = a_3;
    a_3 = _e23 + (view.position * (_e25 - _e26));
    metal::float2 _e30 = b_3;
    metal::float2 _e34 = student_t_impl_slopes_of(lobe_3, next, column_1 + 1u, student_t_tables);
    metal::float2 _e35 = b_3;
    b_3 = _e30 + (view.position * (_e34 - _e35));
    float _e40 = b_3.x;
    float _e42 = a_3.x;
    float _e47 = student_t_impl_max(3.0 * (_e40 - _e42), 0.0);
    float _e49 = a_3.x;
    float _e51 = student_t_impl_max(_e49, 0.0);
    float _e53 = a_3.y;
    float _e55 = student_t_impl_max(_e53, 0.0);
    float _e56 = student_t_impl_min(_e55, _e47);
    a_3 = metal::float2(_e51, _e56);
    float _e59 = b_3.x;
    float _e61 = student_t_impl_max(_e59, 0.0);
    float _e63 = b_3.y;
    float _e65 = student_t_impl_max(_e63, 0.0);
    float _e66 = student_t_impl_min(_e65, _e47);
    b_3 = metal::float2(_e61, _e66);
    metal::float2 _e68 = a_3;
    metal::float2 _e69 = b_3;
    float _e71 = student_t_impl_hermite(_e68, _e69, number.position);
    return _e71;
}

inline metal::float2 student_t_impl_share_at(
    StudentTLobe lobe_4,
    StudentTImplPlace place_4,
    device const uint* student_t_tables
) {
    uint start = lobe_4.masking.start;
    uint _e7 = student_t_impl_table(lobe_4.part + 31u, student_t_tables);
    metal::float4 _e9 = student_t_impl_four(_e7 + start, student_t_tables);
    metal::float4 w_7 = lobe_4.masking.weights * _e9;
    float all = (w_7.x + w_7.y) + (w_7.z + w_7.w);
    uint _e23 = student_t_impl_word(lobe_4.part + 22u, student_t_tables);
    uint _e27 = student_t_impl_table(lobe_4.part + 29u, student_t_tables);
    uint codes_1 = _e27 + (2u * ((place_4.cell * _e23) + start));
    uint _e37 = student_t_impl_table(lobe_4.part + 30u, student_t_tables);
    uint columns = _e37 + (8u * place_4.cell);
    metal::float4 _e42 = student_t_impl_four(columns, student_t_tables);
    metal::float4 _e45 = student_t_impl_four(columns + 4u, student_t_tables);
    metal::float2 _e50 = student_t_impl_sum(codes_1, 2u, w_7, student_t_tables);
    metal::float2 a_15 = (_e42.xz * all) + (_e42.yw * _e50);
    metal::float2 _e59 = student_t_impl_sum(codes_1 + 1u, 2u, w_7, student_t_tables);
    metal::float2 b_7 = (_e45.xz * all) + (_e45.yw * _e59);
    float x_10 = place_4.position;
    float area = (a_15.x + (x_10 * a_15.y)) + ((x_10 * x_10) * (b_7.x + (x_10 * b_7.y)));
    float _e75 = student_t_impl_max(area, 0.000000000000000000000000000000000000011754944);
    uint _e79 = student_t_impl_table(lobe_4.part + 32u, student_t_tables);
    metal::float4 _e84 = student_t_impl_four(_e79 + (4u * place_4.cell), student_t_tables);
    float _e97 = student_t_impl_max((_e84.x + (x_10 * _e84.y)) + ((x_10 * x_10) * (_e84.z + (x_10 * _e84.w))), 0.0);
    return metal::float2(_e97, _e75) / metal::float2(_e97 + _e75);
}

inline float student_t_impl_octaves(
    float x_1
) {
    uint bits = as_type<uint>(x_1);
    float m_7 = (x_1 * as_type<float>((254u - (bits >> 23u)) << 23u)) - 1.0;
    return (static_cast<float>(bits >> 23u) - 127.0) + ((m_7 * ((m_7 * (m_7 - 4.0)) + 10.0)) * 0.14285715);
}

inline StudentTImplThree student_t_impl_three(
    float x_2
) {
    float _e2 = student_t_impl_max(x_2, 0.0);
    float start_1 = metal::floor(_e2 + 0.5);
    float d_1 = x_2 - start_1;
    float half_d = 0.5 * d_1;
    float ends = (half_d * d_1) + 0.125;
    return StudentTImplThree {student_t_impl_f2u32(start_1), {}, metal::float3(ends - half_d, 1.0 - (ends + ends), ends + half_d)};
}

inline StudentTImplAlbedo student_t_impl_albedo_of(
    StudentTLobe lobe_5,
    uint masking,
    device const uint* student_t_tables
) {
    bool local_2 = {};
    uint form = (masking == STUDENT_T_UNCORRELATED) ? 0u : STUDENT_T_IMPL_VOLUME;
    uint t = STUDENT_T_IMPL_VOLUMES + form;
    metal::float4 _e9 = student_t_impl_four(t, student_t_tables);
    metal::float4 _e12 = student_t_impl_four(t + 4u, student_t_tables);
    float _e15 = student_t_impl_float(t + 8u, student_t_tables);
    float _e18 = student_t_impl_float(t + 9u, student_t_tables);
    metal::float2 averages = metal::float2(_e15, _e18);
    float stand_in = metal::sqrt(lobe_5.sigma.x * lobe_5.sigma.y);
    float _e27 = student_t_impl_max(stand_in, _e9.z);
    float _e29 = student_t_impl_min(_e27, _e9.w);
    float twice_1 = (2.0 * lobe_5.gamma) - 3.0;
    float _e36 = student_t_impl_max(twice_1, _e9.x);
    float _e38 = student_t_impl_min(_e36, _e9.y);
    float _e39 = student_t_impl_octaves(_e29);
    float shape = metal::sqrt(metal::sqrt(_e38 / (_e38 + 3.0)));
    float _e49 = student_t_impl_octaves(1.0 + (60.0 * _e29));
    float sigma_7 = (_e49 + (0.2 * _e39)) + _e29;
    if (!(lobe_5.is_mirror)) {
        uint _e60 = student_t_impl_word(t + 22u, student_t_tables);
        local_2 = _e60 == 0u;
    } else {
        local_2 = true;
    }
    bool mirror = local_2;
    StudentTImplThree _e78 = student_t_impl_three((shape - _e12.x) * _e12.z);
    StudentTImplThree _e83 = student_t_impl_three((sigma_7 - _e12.y) * _e12.w);
    return StudentTImplAlbedo {t, mirror ? 0.0 : _e29, _e38, ((_e39 + (2.0 * _e29)) - averages.x) * averages.y, _e78, _e83};
}

inline metal::float4 student_t_impl_row(
    uint at_6,
    device const uint* student_t_tables
) {
    uint word = at_6 >> 1u;
    uint odd = at_6 & 1u;
    metal::float2 _e5 = student_t_impl_codes(word, student_t_tables);
    metal::float2 _e8 = student_t_impl_codes(word + 1u, student_t_tables);
    metal::float2 _e12 = student_t_impl_codes((word + 1u) + odd, student_t_tables);
    return (odd > 0u) ? metal::float4(_e5.y, _e8, _e12.x) : metal::float4(_e5, _e8);
}

inline StudentTImplPlace student_t_impl_place(
    float x_3,
    float last
) {
    uint cell_1 = metal::min(student_t_impl_f2u32(x_3), student_t_impl_f2u32(last));
    return StudentTImplPlace {cell_1, x_3 - static_cast<float>(cell_1)};
}

inline StudentTImplViews student_t_impl_views(
    StudentTImplAlbedo a_4,
    float mu
) {
    float d_2 = a_4.less;
    float sine = metal::sqrt(metal::max((1.0 - mu) * (1.0 + mu), 0.0));
    float x_11 = (d_2 * mu) / ((d_2 * mu) + ((((6.0 * a_4.sigma) * d_2) + a_4.sigma) * sine));
    float h = mu / (1.0 + sine);
    StudentTImplPlace _e35 = student_t_impl_place((14.3 * metal::sqrt(metal::sqrt(x_11))) + (11.7 * metal::sqrt(metal::sqrt(h))), 25.0);
    float t_1 = _e35.position;
    float rest_1 = 1.0 - t_1;
    return StudentTImplViews {_e35.cell, {}, metal::float4(((rest_1 * rest_1) * rest_1) * 0.16666667, 0.6666667 - ((t_1 * t_1) * (1.0 - (0.5 * t_1))), 0.6666667 - ((rest_1 * rest_1) * (1.0 - (0.5 * rest_1))), ((t_1 * t_1) * t_1) * 0.16666667)};
}

inline float student_t_impl_decoded(
    StudentTImplAlbedo a_5,
    uint channel,
    float sum,
    device const uint* student_t_tables
) {
    float _e7 = student_t_impl_float((a_5.volume + 10u) + channel, student_t_tables);
    float _e12 = student_t_impl_float((a_5.volume + 16u) + channel, student_t_tables);
    return _e7 + (_e12 * sum);
}

inline float student_t_impl_channel(
    StudentTImplAlbedo a_6,
    uint channel_1,
    StudentTImplViews views,
    device const uint* student_t_tables
) {
    metal::float4 sum_1 = metal::float4(0.0);
    uint i = 0u;
    uint _e7 = student_t_impl_word((a_6.volume + 22u) + channel_1, student_t_tables);
    uint first = ((_e7 >> 1u) + (((a_6.by_sigma.start * STUDENT_T_IMPL_SHAPES) + a_6.by_shape.start) * STUDENT_T_IMPL_VIEWS)) + views.cell;
    uint2 loop_bound = uint2(4294967295u);
    bool loop_init = true;
    while(true) {
        if (metal::all(loop_bound == uint2(0u))) { break; }
        loop_bound -= uint2(loop_bound.y == 0u, 1u);
        if (!loop_init) {
            uint _e59 = i;
            i = _e59 + 1u;
        }
        loop_init = false;
        uint _e27 = i;
        if (_e27 < 3u) {
        } else {
            break;
        }
        {
            uint _e30 = i;
            uint row_1 = first + (_e30 * 1073u);
            metal::float3 w_8 = a_6.by_shape.weights;
            metal::float4 _e37 = student_t_impl_row(row_1, student_t_tables);
            metal::float4 _e42 = student_t_impl_row(row_1 + STUDENT_T_IMPL_VIEWS, student_t_tables);
            metal::float4 _e48 = student_t_impl_row(row_1 + 58u, student_t_tables);
            metal::float4 codes_2 = ((a_6.by_shape.weights.x * _e37) + (a_6.by_shape.weights.y * _e42)) + (a_6.by_shape.weights.z * _e48);
            metal::float4 _e51 = sum_1;
            uint _e54 = i;
            sum_1 = _e51 + (a_6.by_sigma.weights[_e54] * codes_2);
        }
    }
    metal::float4 _e61 = sum_1;
    float _e64 = student_t_impl_decoded(a_6, channel_1, metal::dot(_e61, views.weights), student_t_tables);
    return _e64;
}

inline float student_t_impl_lost_at(
    StudentTImplAlbedo a_7,
    StudentTImplViews views_1,
    device const uint* student_t_tables
) {
    float _e3 = student_t_impl_channel(a_7, 0u, views_1, student_t_tables);
    return metal::min(_e3 * _e3, 1.0);
}

inline float student_t_impl_unit(
    float x_4
) {
    float _e2 = student_t_impl_max(x_4, 0.0);
    float _e4 = student_t_impl_min(_e2, 1.0);
    return _e4;
}

inline float student_t_impl_lost(
    StudentTImplAlbedo a_8,
    float cos_theta,
    uint masking_1,
    device const uint* student_t_tables
) {
    if (!((a_8.sigma > 0.0))) {
        return 0.0;
    }
    float _e8 = student_t_impl_unit(cos_theta);
    StudentTImplViews _e9 = student_t_impl_views(a_8, _e8);
    float _e10 = student_t_impl_lost_at(a_8, _e9, student_t_tables);
    return _e10;
}

inline metal::float3 student_t_impl_mirror(
    float mu_1
) {
    float k = 1.0 - mu_1;
    float fourth = (k * k) * (k * k);
    return metal::float3(0.0, fourth * k, (17.651384 * mu_1) * (fourth * (k * k)));
}

inline metal::float3 student_t_impl_moments(
    StudentTImplAlbedo a_9,
    float cos_theta_1,
    uint masking_2,
    device const uint* student_t_tables
) {
    float _e3 = student_t_impl_unit(cos_theta_1);
    metal::float3 _e4 = student_t_impl_mirror(_e3);
    if (!((a_9.sigma > 0.0))) {
        return _e4;
    }
    StudentTImplViews _e9 = student_t_impl_views(a_9, _e3);
    float _e10 = student_t_impl_lost_at(a_9, _e9, student_t_tables);
    float _e12 = student_t_impl_channel(a_9, 1u, _e9, student_t_tables);
    float _e14 = student_t_impl_channel(a_9, 2u, _e9, student_t_tables);
    return metal::float3(-(_e10), _e12, _e14) + ((1.0 - _e10) * _e4);
}

inline float student_t_impl_average(
    StudentTImplAlbedo a_10,
    uint channel_2,
    StudentTImplThree by_sigma,
    device const uint* student_t_tables
) {
    float sum_2 = 0.0;
    uint i_1 = 0u;
    uint _e7 = student_t_impl_word((a_10.volume + 22u) + channel_2, student_t_tables);
    uint first_1 = ((_e7 >> 1u) + (by_sigma.start * STUDENT_T_IMPL_SHAPES)) + a_10.by_shape.start;
    uint2 loop_bound_1 = uint2(4294967295u);
    bool loop_init_1 = true;
    while(true) {
        if (metal::all(loop_bound_1 == uint2(0u))) { break; }
        loop_bound_1 -= uint2(loop_bound_1.y == 0u, 1u);
        if (!loop_init_1) {
            uint _e45 = i_1;
            i_1 = _e45 + 1u;
        }
        loop_init_1 = false;
        uint _e21 = i_1;
        if (_e21 < 3u) {
        } else {
            break;
        }
        {
            uint _e24 = i_1;
            metal::float4 _e28 = student_t_impl_row(first_1 + (_e24 * STUDENT_T_IMPL_SHAPES), student_t_tables);
            metal::float3 codes_3 = _e28.xyz * a_10.by_shape.weights;
            float _e33 = sum_2;
            uint _e35 = i_1;
            sum_2 = _e33 + (by_sigma.weights[_e35] * ((codes_3.x + codes_3.y) + codes_3.z));
        }
    }
    float _e47 = sum_2;
    float _e48 = student_t_impl_decoded(a_10, channel_2, _e47, student_t_tables);
    return _e48;
}

inline metal::float3 student_t_impl_mirror_average(
) {
    return metal::float3(0.0, 0.04761905, 0.14009036);
}

inline metal::float3 student_t_impl_averages(
    StudentTImplAlbedo a_11,
    device const uint* student_t_tables
) {
    metal::float3 _e1 = student_t_impl_mirror_average();
    if (!((a_11.sigma > 0.0))) {
        return _e1;
    }
    StudentTImplThree _e7 = student_t_impl_three(a_11.coordinate);
    float _e9 = student_t_impl_average(a_11, 3u, _e7, student_t_tables);
    if (_e9 < -120.0) {
        return _e1;
    }
    float lost = metal::min(metal::exp2(_e9), 1.0);
    float _e16 = student_t_impl_average(a_11, 4u, _e7, student_t_tables);
    float _e18 = student_t_impl_average(a_11, 5u, _e7, student_t_tables);
    return metal::float3(lost, _e16, _e18) + ((1.0 - lost) * _e1);
}

inline float student_t_impl_product(
    float a_12,
    float b_4
) {
    bool local_3 = {};
    if (b_4 > 1.0) {
        local_3 = a_12 > (340282300000000000000000000000000000000.0 / b_4);
    } else {
        local_3 = false;
    }
    bool _e10 = local_3;
    if (_e10) {
        return 340282300000000000000000000000000000000.0;
    }
    return a_12 * b_4;
}

inline float student_t_impl_log_growth(
    float x_5
) {
    bool local_4 = {};
    if (x_5 >= -0.5) {
        local_4 = x_5 <= 1.0;
    } else {
        local_4 = false;
    }
    bool _e8 = local_4;
    if (!(_e8)) {
        return metal::log(1.0 + x_5);
    }
    float y = x_5 / (2.0 + x_5);
    float q = y * y;
    float tail = q * (0.11111111 + (q * (0.09090909 + (q * (0.07692308 + (q * 0.06666667))))));
    return (2.0 * y) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + tail)))))));
}

inline float student_t_impl_log(
    float x_6
) {
    bool local_5 = {};
    if (x_6 >= 0.5) {
        local_5 = x_6 <= 2.0;
    } else {
        local_5 = false;
    }
    bool _e8 = local_5;
    if (_e8) {
        float _e11 = student_t_impl_log_growth(x_6 - 1.0);
        return _e11;
    }
    return metal::log(x_6);
}

inline float student_t_impl_exp_growth(
    float x_7
) {
    if (metal::abs(x_7) > 0.5) {
        return metal::exp(x_7) - 1.0;
    }
    float tail_1 = 0.008333334 + (x_7 * (0.0013888889 + (x_7 * (0.0001984127 + (x_7 * 0.000024801588)))));
    return x_7 * (1.0 + (x_7 * (0.5 + (x_7 * (0.16666667 + (x_7 * (0.041666668 + (x_7 * tail_1))))))));
}

inline StudentTImplDirection student_t_impl_stretch(
    metal::float2 sigma_2,
    metal::float3 w_2
) {
    float _e3 = student_t_impl_unit(w_2.z);
    metal::float2 xy = sigma_2 * w_2.xy;
    float square = (xy.x * xy.x) + (xy.y * xy.y);
    float rho = metal::sqrt(square);
    if (rho >= 0.000001) {
        return StudentTImplDirection {xy, rho, rho, _e3, square};
    } else {
        if (rho >= 0.000000000000000001) {
            return StudentTImplDirection {xy / metal::float2(rho), 1.0, rho, _e3, square};
        }
    }
    float up = (_e3 > 0.0) ? 1.0 : 0.0;
    return StudentTImplDirection {metal::float2(1.0, 0.0), 1.0, 1.0 - up, up, 1.0 - up};
}

inline float student_t_impl_inverse_area(
    StudentTLobe lobe_6,
    StudentTImplDirection d,
    device const uint* student_t_tables
) {
    float at_7 = {};
    if (lobe_6.is_ggx > 0.0) {
        float tall_1 = d.z + metal::sqrt(d.square + (d.z * d.z));
        float _e14 = student_t_impl_max(tall_1, 0.000000000000000000000000000000000000011754944);
        return 2.0 / _e14;
    }
    float across = lobe_6.kappa * d.rho;
    float _e23 = student_t_impl_max(d.z + across, 0.000000000000000000000000000001);
    float r_1 = lobe_6.masking_cells / _e23;
    at_7 = d.z * r_1;
    if (lobe_6.masking_crowded > 0.0) {
        float _e33 = student_t_impl_unit(across / _e23);
        at_7 = (1.0 - metal::sqrt(_e33)) * lobe_6.masking_cells;
    }
    float _e39 = at_7;
    StudentTImplPlace _e41 = student_t_impl_place(_e39, lobe_6.masking_cells);
    float _e42 = student_t_impl_masking_at(lobe_6, _e41, student_t_tables);
    return _e42 * r_1;
}

inline float student_t_impl_dot(
    metal::float3 a_13,
    metal::float3 b_5
) {
    return ((a_13.x * b_5.x) + (a_13.y * b_5.y)) + (a_13.z * b_5.z);
}

inline metal::float3 student_t_impl_raise(
    metal::float3 m,
    float shrink
) {
    float r_2 = 1.0 / metal::sqrt(((m.x * m.x) + (m.z * m.z)) + (m.y * m.y));
    float _e24 = student_t_impl_max((m.z * r_2) * shrink, 0.000000000000000001);
    return metal::float3(m.x * r_2, m.y * r_2, _e24);
}

inline metal::float3 student_t_impl_face(
    metal::float3 v,
    metal::float3 m_1
) {
    float _e2 = student_t_impl_dot(v, m_1);
    if (_e2 < 0.0) {
        float _e5 = student_t_impl_dot(v, v);
        float _e7 = student_t_impl_max(_e5, 0.000000000000000000000000000000000000011754944);
        metal::float3 _e12 = student_t_impl_raise(m_1 - ((_e2 / _e7) * v), 1.0);
        return _e12;
    }
    return m_1;
}

inline float student_t_impl_d(
    StudentTLobe lobe_7,
    metal::float3 m_2,
    float length_square
) {
    bool local_6 = {};
    float root = {};
    float growth = {};
    metal::float2 slope_1 = m_2.xy / lobe_7.sigma;
    float square_1 = m_2.z * m_2.z;
    float part_1 = lobe_7.d_s * ((slope_1.x * slope_1.x) + (slope_1.y * slope_1.y));
    if (m_2.z > 0.0) {
        local_6 = part_1 >= 0.0;
    } else {
        local_6 = false;
    }
    bool _e26 = local_6;
    if (!(_e26)) {
        return 0.0;
    }
    float _e31 = student_t_impl_max(square_1 + part_1, 0.000000000000000000000000000000000000011754944);
    root = length_square / _e31;
    if (!((lobe_7.is_ggx > 0.0))) {
        growth = metal::log(_e31) - (2.0 * metal::log(m_2.z));
        if (part_1 < (1000.0 * square_1)) {
            float _e49 = student_t_impl_log_growth(part_1 / square_1);
            growth = _e49;
        }
        float _e50 = root;
        float _e52 = growth;
        root = _e50 * metal::exp(lobe_7.d_power * _e52);
    }
    float scale = metal::sqrt(1.0 / ((3.1415927 * lobe_7.sigma.x) * lobe_7.sigma.y));
    float _e66 = root;
    float limited = metal::min(scale * metal::min(_e66, 1000000000000000000000000000000.0), 18446742000000000000.0);
    return limited * limited;
}

inline float student_t_lobe_d(
    StudentTLobe lobe_8,
    metal::float3 m_3
) {
    float _e3 = student_t_impl_d(lobe_8, m_3, 1.0);
    return _e3;
}

inline float student_t_lobe_masking(
    StudentTLobe lobe_9,
    metal::float3 w_3,
    device const uint* student_t_tables
) {
    StudentTImplDirection _e3 = student_t_impl_stretch(lobe_9.sigma, w_3);
    float _e5 = student_t_impl_inverse_area(lobe_9, _e3, student_t_tables);
    float _e8 = student_t_impl_min(_e3.z * _e5, 1.0);
    return _e8;
}

inline float student_t_lobe_lambda(
    StudentTLobe lobe_10,
    metal::float3 w_4,
    device const uint* student_t_tables
) {
    float _e2 = student_t_lobe_masking(lobe_10, w_4, student_t_tables);
    float _e4 = student_t_impl_max(_e2, 0.000000000000000000000000000000000000011754944);
    return (1.0 / _e4) - 1.0;
}

inline float student_t_lobe_masking_shadowing(
    StudentTLobe lobe_11,
    metal::float3 v_1,
    metal::float3 l,
    uint masking_3,
    device const uint* student_t_tables
) {
    bool local_7 = {};
    float _e4 = student_t_lobe_masking(lobe_11, v_1, student_t_tables);
    float _e5 = student_t_lobe_masking(lobe_11, l, student_t_tables);
    float both = _e4 * _e5;
    float sum_4 = (_e4 + _e5) - both;
    if (!((masking_3 == STUDENT_T_UNCORRELATED))) {
        local_7 = !((sum_4 > 0.0));
    } else {
        local_7 = true;
    }
    bool _e18 = local_7;
    if (_e18) {
        return both;
    }
    return both / sum_4;
}

inline float student_t_impl_weight(
    float a_14,
    float b_6,
    uint masking_4
) {
    if (!((b_6 > 0.0))) {
        return 0.0;
    }
    if (masking_4 == STUDENT_T_UNCORRELATED) {
        return b_6;
    }
    return b_6 / (b_6 + (a_14 * (1.0 - b_6)));
}

inline float student_t_lobe_reflection_weight(
    StudentTLobe lobe_12,
    metal::float3 v_2,
    metal::float3 l_1,
    uint masking_5,
    device const uint* student_t_tables
) {
    if (!((v_2.z > 0.0))) {
        return 0.0;
    }
    float _e9 = student_t_lobe_masking(lobe_12, v_2, student_t_tables);
    float _e10 = student_t_lobe_masking(lobe_12, l_1, student_t_tables);
    float _e11 = student_t_impl_weight(_e9, _e10, masking_5);
    return _e11;
}

inline metal::float2 student_t_lobe_eval_pdf(
    StudentTLobe lobe_13,
    metal::float3 v_3,
    metal::float3 l_2,
    uint masking_6,
    device const uint* student_t_tables
) {
    bool local_8 = {};
    if (v_3.z > 0.0) {
        local_8 = l_2.z > 0.0;
    } else {
        local_8 = false;
    }
    bool _e13 = local_8;
    if (!(_e13)) {
        return metal::float2(0.0);
    }
    metal::float3 both_1 = v_3 + l_2;
    metal::float3 m_8 = metal::float3(both_1.xy, metal::max(both_1.z, 0.00000000000000000007666467));
    StudentTImplDirection _e24 = student_t_impl_stretch(lobe_13.sigma, v_3);
    float _e25 = student_t_impl_inverse_area(lobe_13, _e24, student_t_tables);
    float _e29 = student_t_impl_min(_e24.z * _e25, 1.0);
    float _e30 = student_t_lobe_masking(lobe_13, l_2, student_t_tables);
    float _e31 = student_t_impl_weight(_e29, _e30, masking_6);
    float _e32 = student_t_impl_dot(m_8, m_8);
    float _e33 = student_t_impl_d(lobe_13, m_8, _e32);
    float density = 0.25 * _e33;
    float _e36 = student_t_impl_product(density, _e25);
    float _e43 = student_t_impl_product(_e31 * _e36, 1.0 / metal::max(l_2.z, 0.0000000000000000000000000000000000001));
    return metal::float2(_e43, _e36);
}

inline bool student_t_effectively_smooth(
    StudentTLobe lobe_14,
    device const uint* student_t_tables
) {
    bool local_9 = {};
    float sigma_8 = metal::max(lobe_14.sigma.x, lobe_14.sigma.y);
    if (!(((0.56 * sigma_8) < 0.001))) {
        return false;
    }
    StudentTImplDirection level = StudentTImplDirection {metal::float2(0.0), 1.0, 1.0, 0.0, 1.0};
    float _e19 = student_t_impl_inverse_area(lobe_14, level, student_t_tables);
    float mean = 2.0 / _e19;
    float rho_1 = 0.99995 * sigma_8;
    StudentTImplDirection grazing = StudentTImplDirection {metal::float2(0.0), 1.0, rho_1, 0.01, rho_1 * rho_1};
    if ((sigma_8 * mean) < 0.001) {
        float _e35 = student_t_impl_inverse_area(lobe_14, grazing, student_t_tables);
        local_9 = (1.0 - (0.01 * _e35)) <= 0.0025;
    } else {
        local_9 = false;
    }
    bool _e43 = local_9;
    return _e43;
}

inline float student_t_impl_sine(
    float x_8
) {
    float y_1 = x_8 * x_8;
    float tail_2 = y_1 * (81.60248 + (y_1 * (-76.58117 + (y_1 * 39.759827))));
    return x_8 * (6.2831855 + (y_1 * (-41.34168 + tail_2)));
}

inline metal::float2 student_t_impl_turn(
    float u
) {
    float x_12 = 0.5 - u;
    float quarter = metal::abs(x_12) - 0.25;
    float rest_2 = 0.25 - metal::abs(quarter);
    float _e9 = student_t_impl_sine(quarter);
    float _e14 = student_t_impl_sine((x_12 < 0.0) ? -(rest_2) : rest_2);
    return metal::float2(_e9, _e14);
}

inline metal::float3 student_t_impl_sample_cap(
    metal::float2 sigma_3,
    metal::float3 v_4,
    metal::float2 u_1
) {
    metal::float3 w_5 = {};
    float tall = {};
    float _e6 = student_t_impl_max(v_4.z, 0.0);
    metal::float3 above = metal::float3(v_4.xy, _e6);
    w_5 = metal::float3(sigma_3 * above.xy, above.z);
    metal::float3 _e13 = w_5;
    metal::float3 _e14 = w_5;
    float _e15 = student_t_impl_dot(_e13, _e14);
    tall = metal::sqrt(_e15);
    float _e18 = tall;
    if (!((_e18 >= 0.000001))) {
        metal::float3 _e26 = w_5;
        float _e27 = tall;
        float _e32 = tall;
        w_5 = (_e32 > 0.0) ? (_e26 / metal::float3(metal::max(_e27, 0.0000000000000000000000000000000000001))) : metal::float3(0.0, 0.0, 1.0);
        tall = 1.0;
    }
    float _e38 = student_t_impl_unit(u_1.x);
    float _e43 = tall;
    float _e45 = w_5.z;
    float height = metal::max(1.0 - _e38, 0.000000059604645) * (_e43 + _e45);
    float _e49 = w_5.z;
    float up_1 = height - _e49;
    float _e51 = tall;
    float _e53 = tall;
    float radius = metal::sqrt(metal::max((_e51 - up_1) * (_e53 + up_1), 0.0));
    metal::float3 _e59 = w_5;
    float _e62 = student_t_impl_unit(u_1.y);
    metal::float2 _e63 = student_t_impl_turn(_e62);
    metal::float2 point = _e59.xy + (radius * _e63);
    metal::float3 _e69 = student_t_impl_raise(metal::float3(sigma_3 * point, height), 1.0);
    metal::float3 _e70 = student_t_impl_face(above, _e69);
    return _e70;
}

inline float student_t_impl_end(
    float u_2
) {
    float _e3 = student_t_impl_min(u_2, 1.0 - u_2);
    float _e5 = student_t_impl_max(_e3, 0.0);
    return metal::sqrt(metal::sqrt(_e5));
}

inline StudentTImplHalfSlope student_t_impl_heavy_slope(
    StudentTLobe lobe_15,
    float number_1
) {
    float _e4 = student_t_impl_log(metal::max(number_1, 0.0000000000000000000000000000000000001));
    float power = metal::max(_e4 * lobe_15.heavy_exponent, -69.3);
    float zeta = metal::exp(power);
    float large = metal::max(zeta, 0.000000000000001);
    float _e14 = student_t_impl_exp_growth(2.0 * power);
    float x_13 = 0.5 * metal::sqrt(metal::max(-(_e14), 0.0));
    float z = large * lobe_15.heavy_root_s;
    return StudentTImplHalfSlope {x_13, z, 1.0, zeta / large, x_13 + z};
}

inline StudentTImplHalfSlope student_t_impl_table_slope(
    StudentTLobe lobe_16,
    float along,
    float at_8,
    float silhouette,
    device const uint* student_t_tables
) {
    bool second_2 = along > 0.5;
    StudentTImplPlace _e7 = student_t_impl_place(at_8, lobe_16.rows);
    float _e8 = student_t_impl_end(along);
    StudentTImplPlace _e14 = student_t_impl_place(_e8 * lobe_16.along_scale, lobe_16.numbers - 1.0);
    float _e16 = student_t_impl_along_at(lobe_16, _e7, static_cast<uint>(second_2), _e14, student_t_tables);
    float sign = second_2 ? -1.0 : 1.0;
    float clear = _e16 - (second_2 ? 0.0 : silhouette);
    return StudentTImplHalfSlope {_e16 - 1.0, _e16 * (2.0 - _e16), sign, 1.0, clear};
}

inline metal::float3 student_t_impl_sample_tables(
    StudentTLobe lobe_17,
    metal::float3 v_5,
    metal::float2 u_3,
    device const uint* student_t_tables
) {
    float rest = {};
    float along_1 = {};
    bool is_heavy = false;
    float number_2 = 1.0;
    StudentTImplHalfSlope slope = {};
    float _e4 = student_t_impl_end(u_3.y);
    StudentTImplPlace _e12 = student_t_impl_place(_e4 * lobe_17.across_scale, (0.8408964 * lobe_17.across_scale) + 0.5);
    float _e13 = student_t_impl_across_at(lobe_17, _e12, student_t_tables);
    float t_2 = (u_3.y > 0.5) ? (1.0 - _e13) : (_e13 - 1.0);
    float tz = _e13 * (2.0 - _e13);
    StudentTImplDirection _e26 = student_t_impl_stretch(lobe_17.sigma, v_5);
    float tall_2 = metal::sqrt(_e26.square + (_e26.z * _e26.z));
    rest = 1.0 - (_e26.z / (_e26.rho + tall_2));
    if (lobe_17.heavy_per_row > 0.0) {
        float steep = tall_2 + _e26.z;
        rest = (_e26.rho * (steep + _e26.rho)) / (steep * (_e26.rho + tall_2));
    }
    float _e53 = rest;
    float _e54 = student_t_impl_unit(_e53);
    float at_12 = metal::max(metal::max(lobe_17.rows_first - (lobe_17.rows_first * _e54), lobe_17.rows_second_end - (lobe_17.rows_second * _e54)), lobe_17.rows - (lobe_17.rows_third * _e54));
    float _e70 = student_t_impl_unit(u_3.x);
    along_1 = _e70;
    if (lobe_17.heavy_per_row > 0.0) {
        float cells = lobe_17.heavy_per_row;
        StudentTImplPlace _e83 = student_t_impl_place(at_12 * cells, lobe_17.rows * cells);
        metal::float2 _e84 = student_t_impl_share_at(lobe_17, _e83, student_t_tables);
        float _e85 = along_1;
        is_heavy = _e85 > _e84.y;
        bool _e88 = is_heavy;
        if (_e88) {
            float _e89 = along_1;
            number_2 = metal::min((1.0 - _e89) / _e84.x, 1.0);
        }
        float _e96 = along_1;
        along_1 = _e96 / _e84.y;
    }
    bool _e100 = is_heavy;
    if (_e100) {
        float _e101 = number_2;
        StudentTImplHalfSlope _e102 = student_t_impl_heavy_slope(lobe_17, _e101);
        slope = _e102;
    } else {
        float _e103 = along_1;
        StudentTImplHalfSlope _e104 = student_t_impl_table_slope(lobe_17, _e103, at_12, _e54, student_t_tables);
        slope = _e104;
    }
    float _e106 = slope.z;
    float _e108 = slope.z;
    float _e114 = slope.x;
    float _e116 = slope.x;
    float norm = metal::sqrt((_e106 * _e108) + ((4.0 * lobe_17.s) * (_e114 * _e116)));
    float _e122 = slope.x;
    float _e124 = slope.sign;
    float ahead = _e122 * (_e124 * tz);
    float aside = norm * t_2;
    metal::float2 turned = metal::float2((ahead * _e26.xy.x) - (aside * _e26.xy.y), (ahead * _e26.xy.y) + (aside * _e26.xy.x));
    float _e146 = slope.z;
    float _e154 = slope.shrink;
    metal::float3 _e155 = student_t_impl_raise(metal::float3(lobe_17.sigma * turned, _e146 * (0.5 * (_e26.frame * tz))), _e154);
    float _e157 = slope.clear;
    if (!(((_e157 * tz) >= ((0.00001 * tz) + (0.00002 * metal::abs(t_2)))))) {
        metal::float3 _e170 = student_t_impl_face(metal::float3(v_5.xy, _e26.z), _e155);
        return _e170;
    }
    return _e155;
}

inline metal::float3 student_t_lobe_sample_visible_normal(
    StudentTLobe lobe_18,
    metal::float3 v_6,
    metal::float2 u_4,
    device const uint* student_t_tables
) {
    if (lobe_18.is_ggx > 0.0) {
        metal::float3 _e7 = student_t_impl_sample_cap(lobe_18.sigma, v_6, u_4);
        return _e7;
    }
    metal::float3 _e8 = student_t_impl_sample_tables(lobe_18, v_6, u_4, student_t_tables);
    return _e8;
}

inline float student_t_lobe_visible_normal_pdf(
    StudentTLobe lobe_19,
    metal::float3 v_7,
    metal::float3 m_4,
    device const uint* student_t_tables
) {
    float _e3 = student_t_impl_dot(v_7, m_4);
    float _e5 = student_t_impl_max(_e3, 0.0);
    float _e6 = student_t_lobe_d(lobe_19, m_4);
    float density_1 = _e5 * _e6;
    StudentTImplDirection _e9 = student_t_impl_stretch(lobe_19.sigma, v_7);
    float _e10 = student_t_impl_inverse_area(lobe_19, _e9, student_t_tables);
    float _e11 = student_t_impl_product(density_1, _e10);
    return _e11;
}

inline metal::float3 student_t_reflect(
    metal::float3 v_8,
    metal::float3 m_5
) {
    float _e2 = student_t_impl_dot(v_8, m_5);
    return ((2.0 * _e2) * m_5) - v_8;
}

inline float student_t_lobe_reflection_pdf(
    StudentTLobe lobe_20,
    metal::float3 v_9,
    metal::float3 m_6,
    device const uint* student_t_tables
) {
    float _e3 = student_t_impl_dot(v_9, m_6);
    if (!((_e3 > 0.0))) {
        return 0.0;
    }
    float _e8 = student_t_lobe_d(lobe_20, m_6);
    float density_2 = 0.25 * _e8;
    StudentTImplDirection _e12 = student_t_impl_stretch(lobe_20.sigma, v_9);
    float _e13 = student_t_impl_inverse_area(lobe_20, _e12, student_t_tables);
    float _e14 = student_t_impl_product(density_2, _e13);
    return _e14;
}

inline float student_t_impl_tail(
    float gamma_1
) {
    float _e2 = student_t_impl_max(gamma_1, 1.501);
    float _e4 = student_t_impl_min(_e2, 1000000000000.0);
    return 1.0 / (_e4 - 1.0);
}

inline float student_t_impl_facing_pdf(
    float slope2_,
    float sigma_4,
    float s
) {
    float x_14 = (slope2_ / sigma_4) / sigma_4;
    float _e11 = student_t_impl_log_growth(s * x_14);
    float power_1 = metal::exp(-((1.0 + (1.0 / s))) * _e11);
    float scale_1 = (1.0 + slope2_) / sigma_4;
    float _e18 = student_t_impl_product(power_1 * scale_1, scale_1);
    float _e20 = student_t_impl_product(_e18, 0.07957747);
    return _e20;
}

inline metal::float4 student_t_prefilter_light(
    metal::float2 u_5,
    float sigma_5,
    float gamma_2
) {
    float _e3 = student_t_impl_tail(gamma_2);
    float _e4 = student_t_impl_sigma(sigma_5);
    float _e6 = student_t_impl_unit(u_5.x);
    float _e8 = student_t_impl_min(_e6, 0.99999994);
    float _e11 = student_t_impl_log_growth(-(_e8));
    float _e13 = student_t_impl_exp_growth(-(_e3) * _e11);
    float slope_2 = _e4 * metal::sqrt(_e13 / _e3);
    float slope_2_ = slope_2 * slope_2;
    float secant_2_ = 1.0 + slope_2_;
    float sine_1 = (2.0 * slope_2) / secant_2_;
    float _e24 = student_t_impl_unit(u_5.y);
    metal::float2 _e25 = student_t_impl_turn(_e24);
    float _e26 = student_t_impl_facing_pdf(slope_2_, _e4, _e3);
    return metal::float4(sine_1 * _e25, (1.0 - slope_2_) / secant_2_, _e26);
}

inline float student_t_prefilter_pdf(
    float cos_theta_2,
    float sigma_6,
    float gamma_3
) {
    float _e3 = student_t_impl_unit(cos_theta_2);
    if (!((cos_theta_2 > 0.0))) {
        return 0.0;
    }
    float _e8 = student_t_impl_tail(gamma_3);
    float _e14 = student_t_impl_sigma(sigma_6);
    float _e15 = student_t_impl_facing_pdf((1.0 - _e3) / (1.0 + _e3), _e14, _e8);
    return _e15;
}

inline metal::float3 student_t_impl_limit(
    metal::float3 moments
) {
    float _e3 = student_t_impl_max(moments.y, 0.0);
    float _e5 = student_t_impl_min(_e3, moments.x);
    float _e9 = student_t_impl_unit(moments.z);
    return metal::float3(moments.x - _e5, _e5, _e9);
}

inline float student_t_lobe_albedo(
    StudentTLobe lobe_21,
    float cos_theta_3,
    uint masking_7,
    device const uint* student_t_tables
) {
    StudentTImplAlbedo _e3 = student_t_impl_albedo_of(lobe_21, masking_7, student_t_tables);
    float _e4 = student_t_impl_lost(_e3, cos_theta_3, masking_7, student_t_tables);
    return 1.0 - _e4;
}

inline metal::float3 student_t_lobe_albedo_parts(
    StudentTLobe lobe_22,
    float cos_theta_4,
    uint masking_8,
    device const uint* student_t_tables
) {
    StudentTImplAlbedo _e3 = student_t_impl_albedo_of(lobe_22, masking_8, student_t_tables);
    metal::float3 _e4 = student_t_impl_moments(_e3, cos_theta_4, masking_8, student_t_tables);
    metal::float3 _e10 = student_t_impl_limit(metal::float3(1.0 + _e4.x, _e4.yz));
    return _e10;
}

inline float student_t_lobe_albedo_average(
    StudentTLobe lobe_23,
    uint masking_9,
    device const uint* student_t_tables
) {
    StudentTImplAlbedo _e2 = student_t_impl_albedo_of(lobe_23, masking_9, student_t_tables);
    metal::float3 _e3 = student_t_impl_averages(_e2, student_t_tables);
    return 1.0 - _e3.x;
}

inline metal::float3 student_t_lobe_albedo_average_parts(
    StudentTLobe lobe_24,
    uint masking_10,
    device const uint* student_t_tables
) {
    StudentTImplAlbedo _e2 = student_t_impl_albedo_of(lobe_24, masking_10, student_t_tables);
    metal::float3 _e3 = student_t_impl_averages(_e2, student_t_tables);
    metal::float3 _e9 = student_t_impl_limit(metal::float3(1.0 - _e3.x, _e3.yz));
    return _e9;
}

inline float student_t_impl_kulla_conty(
    float lost_v,
    float lost_l,
    float average
) {
    if (!((average > 0.000000000000000000000000000000000000011754944))) {
        return 0.0;
    }
    return ((0.31830987 * lost_v) * lost_l) / average;
}

inline float student_t_lobe_compensation(
    StudentTLobe lobe_25,
    metal::float3 v_10,
    metal::float3 l_3,
    uint masking_11,
    device const uint* student_t_tables
) {
    bool local_10 = {};
    if (v_10.z > 0.0) {
        local_10 = l_3.z > 0.0;
    } else {
        local_10 = false;
    }
    bool _e13 = local_10;
    if (!(_e13)) {
        return 0.0;
    }
    StudentTImplAlbedo _e16 = student_t_impl_albedo_of(lobe_25, masking_11, student_t_tables);
    float _e18 = student_t_impl_lost(_e16, v_10.z, masking_11, student_t_tables);
    float _e20 = student_t_impl_lost(_e16, l_3.z, masking_11, student_t_tables);
    metal::float3 _e21 = student_t_impl_averages(_e16, student_t_tables);
    float _e23 = student_t_impl_kulla_conty(_e18, _e20, _e21.x);
    return _e23;
}

inline float student_t_compensation_from(
    float e_v,
    float e_l,
    float e_average
) {
    float _e9 = student_t_impl_kulla_conty(1.0 - e_v, 1.0 - e_l, 1.0 - e_average);
    return _e9;
}

#endif
