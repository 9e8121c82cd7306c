#ifndef STUDENT_T
#define STUDENT_T

#include <metal_stdlib>
#include <simd/simd.h>

using metal::uint;


struct StudentTLobe {
    metal::float2 sigma;
    bool is_mirror;
    char _pad2[3];
    uint shape;
    float is_ggx;
    float s;
    float d_s;
    float d_power;
    float kappa;
    float masking_crowded;
    float masking_cells;
    uint masking;
    float rows;
    float rows_first;
    float rows_second;
    float rows_second_end;
    float rows_third;
    float numbers;
    float along_scale;
    uint slopes;
    float across_scale;
    uint across;
    float heavy_per_row;
    uint heavy;
    float heavy_exponent;
    float heavy_root_s;
};
struct StudentTAlbedoTable {
    uint values;
    uint averages;
    float sigmas;
    float average_sigmas;
    float views;
    float offset;
    float first;
    float slow;
    float linear;
    float start;
    float range;
    float sigma_min;
    float sigma_max;
    float weight;
    float normal;
    float share;
    float kappa;
    float spread;
    float floor;
    float slope;
};
struct StudentTImplPlace {
    uint cell;
    float position;
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
struct StudentTImplAlbedo {
    StudentTAlbedoTable table;
    float sigma;
    float coordinate;
    float lowest;
};
struct StudentTImplSix {
    uint start;
    char _pad1[12];
    metal::float3 a;
    metal::float3 b;
};
constant uint STUDENT_T_UNCORRELATED = 0u;
constant uint STUDENT_T_HEIGHT_CORRELATED = 1u;

inline metal::float2 student_t_impl_pair(
    uint at,
    device const metal::float2* student_t_tables
) {
    metal::float2 _e3 = student_t_tables[at];
    return _e3;
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

inline StudentTLobe student_t_lobe_of(
    uint shape,
    metal::float2 sigma_1,
    device const metal::float2* student_t_tables
) {
    bool local = {};
    metal::float2 _e4 = student_t_impl_pair(shape + 0u, student_t_tables);
    metal::float2 _e7 = student_t_impl_pair(shape + 1u, student_t_tables);
    metal::float2 _e10 = student_t_impl_pair(shape + 2u, student_t_tables);
    metal::float2 _e13 = student_t_impl_pair(shape + 3u, student_t_tables);
    metal::float2 _e16 = student_t_impl_pair(shape + 4u, student_t_tables);
    metal::float2 _e19 = student_t_impl_pair(shape + 5u, student_t_tables);
    metal::float2 _e22 = student_t_impl_pair(shape + 6u, student_t_tables);
    metal::float2 _e25 = student_t_impl_pair(shape + 7u, student_t_tables);
    metal::float2 _e28 = student_t_impl_pair(shape + 8u, student_t_tables);
    metal::float2 _e31 = student_t_impl_pair(shape + 9u, student_t_tables);
    metal::float2 _e34 = student_t_impl_pair(shape + 10u, student_t_tables);
    float _e36 = student_t_impl_sigma(sigma_1.x);
    float _e38 = student_t_impl_sigma(sigma_1.y);
    if (sigma_1.x > 0.0) {
        local = sigma_1.y > 0.0;
    } else {
        local = false;
    }
    bool _e49 = local;
    return StudentTLobe {metal::float2(_e36, _e38), !(_e49), {}, shape, _e4.x, _e4.y, _e7.x, _e7.y, _e10.x, _e10.y, _e13.x, shape + student_t_impl_f2u32(_e13.y), _e16.x, _e16.y, _e19.x, _e19.y, _e22.x, _e22.y, _e25.x, shape + student_t_impl_f2u32(_e25.y), _e28.x, shape + student_t_impl_f2u32(_e28.y), _e31.x, shape + student_t_impl_f2u32(_e31.y), _e34.x, _e34.y};
}

inline StudentTAlbedoTable student_t_impl_albedo_table(
    uint shape_1,
    uint masking,
    device const metal::float2* student_t_tables
) {
    uint at_5 = shape_1 + ((masking == STUDENT_T_UNCORRELATED) ? 11u : 21u);
    metal::float2 _e10 = student_t_impl_pair(at_5 + 0u, student_t_tables);
    metal::float2 _e13 = student_t_impl_pair(at_5 + 1u, student_t_tables);
    metal::float2 _e16 = student_t_impl_pair(at_5 + 2u, student_t_tables);
    metal::float2 _e19 = student_t_impl_pair(at_5 + 3u, student_t_tables);
    metal::float2 _e22 = student_t_impl_pair(at_5 + 4u, student_t_tables);
    metal::float2 _e25 = student_t_impl_pair(at_5 + 5u, student_t_tables);
    metal::float2 _e28 = student_t_impl_pair(at_5 + 6u, student_t_tables);
    metal::float2 _e31 = student_t_impl_pair(at_5 + 7u, student_t_tables);
    metal::float2 _e34 = student_t_impl_pair(at_5 + 8u, student_t_tables);
    metal::float2 _e37 = student_t_impl_pair(at_5 + 9u, student_t_tables);
    return StudentTAlbedoTable {shape_1 + student_t_impl_f2u32(_e10.x), shape_1 + student_t_impl_f2u32(_e10.y), _e13.x, _e13.y, _e16.x, _e16.y, _e19.x, _e19.y, _e22.x, _e22.y, _e25.x, _e25.y, _e28.x, _e28.y, _e31.x, _e31.y, _e34.x, _e34.y, _e37.x, _e37.y};
}

inline float student_t_impl_unit(
    float x
) {
    float _e2 = student_t_impl_max(x, 0.0);
    float _e4 = student_t_impl_min(_e2, 1.0);
    return _e4;
}

inline float student_t_impl_product(
    float a_2,
    float b_2
) {
    bool local_1 = {};
    if (b_2 > 1.0) {
        local_1 = a_2 > (340282300000000000000000000000000000000.0 / b_2);
    } else {
        local_1 = false;
    }
    bool _e10 = local_1;
    if (_e10) {
        return 340282300000000000000000000000000000000.0;
    }
    return a_2 * b_2;
}

inline float student_t_impl_log_growth(
    float x_1
) {
    bool local_2 = {};
    if (x_1 >= -0.5) {
        local_2 = x_1 <= 1.0;
    } else {
        local_2 = false;
    }
    bool _e8 = local_2;
    if (!(_e8)) {
        return metal::log(1.0 + x_1);
    }
    float y = x_1 / (2.0 + x_1);
    float q = y * y;
    float tail = q * (0.11111111 + (q * (0.09090909 + (q * (0.07692308 + (q * 0.06666667))))));
    return (2.0 * y) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + tail)))))));
}

inline float student_t_impl_log(
    float x_2
) {
    bool local_3 = {};
    if (x_2 >= 0.5) {
        local_3 = x_2 <= 2.0;
    } else {
        local_3 = false;
    }
    bool _e8 = local_3;
    if (_e8) {
        float _e11 = student_t_impl_log_growth(x_2 - 1.0);
        return _e11;
    }
    return metal::log(x_2);
}

inline float student_t_impl_exp_growth(
    float x_3
) {
    if (metal::abs(x_3) > 0.5) {
        return metal::exp(x_3) - 1.0;
    }
    float tail_1 = 0.008333334 + (x_3 * (0.0013888889 + (x_3 * (0.0001984127 + (x_3 * 0.000024801588)))));
    return x_3 * (1.0 + (x_3 * (0.5 + (x_3 * (0.16666667 + (x_3 * (0.041666668 + (x_3 * tail_1))))))));
}

inline StudentTImplPlace student_t_impl_place(
    float x_4,
    float last
) {
    uint cell = metal::min(student_t_impl_f2u32(x_4), student_t_impl_f2u32(last));
    return StudentTImplPlace {cell, x_4 - static_cast<float>(cell)};
}

inline float student_t_impl_hermite(
    metal::float2 a_3,
    metal::float2 b_3,
    float w
) {
    float value_a = 1.0 + (w * (w * ((w * 2.0) - 3.0)));
    float slope_a = w * (1.0 + (w * (w - 2.0)));
    float value_b = w * (w * (3.0 - (w * 2.0)));
    float slope_b = w * (w * (w - 1.0));
    return ((a_3.x * value_a) + (b_3.x * value_b)) + ((a_3.y * slope_a) + (b_3.y * slope_b));
}

inline StudentTImplDirection student_t_impl_stretch(
    metal::float2 sigma_2,
    metal::float3 w_1
) {
    float _e3 = student_t_impl_unit(w_1.z);
    metal::float2 xy = sigma_2 * w_1.xy;
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

inline float student_t_impl_cubic(
    uint table,
    StudentTImplPlace place,
    device const metal::float2* student_t_tables
) {
    metal::float2 _e6 = student_t_impl_pair(table + (2u * place.cell), student_t_tables);
    metal::float2 _e13 = student_t_impl_pair((table + (2u * place.cell)) + 1u, student_t_tables);
    float w_7 = place.position;
    return (_e6.x + (w_7 * _e6.y)) + ((w_7 * w_7) * (_e13.x + (w_7 * _e13.y)));
}

inline float student_t_impl_masking_at(
    StudentTLobe lobe,
    StudentTImplPlace place_1,
    device const metal::float2* student_t_tables
) {
    float _e3 = student_t_impl_cubic(lobe.masking, place_1, student_t_tables);
    return _e3;
}

inline float student_t_impl_inverse_area(
    StudentTLobe lobe_1,
    StudentTImplDirection d,
    device const metal::float2* student_t_tables
) {
    float at_1 = {};
    if (lobe_1.is_ggx > 0.0) {
        float tall_1 = d.z + metal::sqrt(d.square + (d.z * d.z));
        float _e14 = student_t_impl_max(tall_1, 0.000000000000000000000000000000000000011754944);
        return 2.0 / _e14;
    }
    float across = lobe_1.kappa * d.rho;
    float _e23 = student_t_impl_max(d.z + across, 0.000000000000000000000000000001);
    float r = lobe_1.masking_cells / _e23;
    at_1 = d.z * r;
    if (lobe_1.masking_crowded > 0.0) {
        float _e33 = student_t_impl_unit(across / _e23);
        at_1 = (1.0 - metal::sqrt(_e33)) * lobe_1.masking_cells;
    }
    float _e39 = at_1;
    StudentTImplPlace _e41 = student_t_impl_place(_e39, lobe_1.masking_cells);
    float _e42 = student_t_impl_masking_at(lobe_1, _e41, student_t_tables);
    return _e42 * r;
}

inline float student_t_impl_dot(
    metal::float3 a_4,
    metal::float3 b_4
) {
    return ((a_4.x * b_4.x) + (a_4.y * b_4.y)) + (a_4.z * b_4.z);
}

inline metal::float3 student_t_impl_raise(
    metal::float3 m,
    float shrink
) {
    float r_1 = 1.0 / metal::sqrt(((m.x * m.x) + (m.z * m.z)) + (m.y * m.y));
    float _e24 = student_t_impl_max((m.z * r_1) * shrink, 0.000000000000000001);
    return metal::float3(m.x * r_1, m.y * r_1, _e24);
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
    StudentTLobe lobe_2,
    metal::float3 m_2,
    float length_square
) {
    bool local_4 = {};
    float root = {};
    float growth = {};
    metal::float2 slope_1 = m_2.xy / lobe_2.sigma;
    float square_1 = m_2.z * m_2.z;
    float part = lobe_2.d_s * ((slope_1.x * slope_1.x) + (slope_1.y * slope_1.y));
    if (m_2.z > 0.0) {
        local_4 = part >= 0.0;
    } else {
        local_4 = false;
    }
    bool _e26 = local_4;
    if (!(_e26)) {
        return 0.0;
    }
    float _e31 = student_t_impl_max(square_1 + part, 0.000000000000000000000000000000000000011754944);
    root = length_square / _e31;
    if (!((lobe_2.is_ggx > 0.0))) {
        growth = metal::log(_e31) - (2.0 * metal::log(m_2.z));
        if (part < (1000.0 * square_1)) {
            float _e49 = student_t_impl_log_growth(part / square_1);
            growth = _e49;
        }
        float _e50 = root;
        float _e52 = growth;
        root = _e50 * metal::exp(lobe_2.d_power * _e52);
    }
    float scale = metal::sqrt(1.0 / ((3.1415927 * lobe_2.sigma.x) * lobe_2.sigma.y));
    float _e66 = root;
    float limited = metal::min(scale * metal::min(_e66, 1000000000000000000000000000000.0), 18446742000000000000.0);
    return limited * limited;
}

inline float student_t_lobe_d(
    StudentTLobe lobe_3,
    metal::float3 m_3
) {
    float _e3 = student_t_impl_d(lobe_3, m_3, 1.0);
    return _e3;
}

inline float student_t_lobe_masking(
    StudentTLobe lobe_4,
    metal::float3 w_2,
    device const metal::float2* student_t_tables
) {
    StudentTImplDirection _e3 = student_t_impl_stretch(lobe_4.sigma, w_2);
    float _e5 = student_t_impl_inverse_area(lobe_4, _e3, student_t_tables);
    float _e8 = student_t_impl_min(_e3.z * _e5, 1.0);
    return _e8;
}

inline float student_t_lobe_lambda(
    StudentTLobe lobe_5,
    metal::float3 w_3,
    device const metal::float2* student_t_tables
) {
    float _e2 = student_t_lobe_masking(lobe_5, w_3, student_t_tables);
    float _e4 = student_t_impl_max(_e2, 0.000000000000000000000000000000000000011754944);
    return (1.0 / _e4) - 1.0;
}

inline float student_t_lobe_masking_shadowing(
    StudentTLobe lobe_6,
    metal::float3 v_1,
    metal::float3 l,
    uint masking_1,
    device const metal::float2* student_t_tables
) {
    bool local_5 = {};
    float _e4 = student_t_lobe_masking(lobe_6, v_1, student_t_tables);
    float _e5 = student_t_lobe_masking(lobe_6, l, student_t_tables);
    float both = _e4 * _e5;
    float sum = (_e4 + _e5) - both;
    if (!((masking_1 == STUDENT_T_UNCORRELATED))) {
        local_5 = !((sum > 0.0));
    } else {
        local_5 = true;
    }
    bool _e18 = local_5;
    if (_e18) {
        return both;
    }
    return both / sum;
}

inline float student_t_impl_weight(
    float a_5,
    float b_5,
    uint masking_2
) {
    if (!((b_5 > 0.0))) {
        return 0.0;
    }
    if (masking_2 == STUDENT_T_UNCORRELATED) {
        return b_5;
    }
    return b_5 / (b_5 + (a_5 * (1.0 - b_5)));
}

inline float student_t_lobe_reflection_weight(
    StudentTLobe lobe_7,
    metal::float3 v_2,
    metal::float3 l_1,
    uint masking_3,
    device const metal::float2* student_t_tables
) {
    if (!((v_2.z > 0.0))) {
        return 0.0;
    }
    float _e9 = student_t_lobe_masking(lobe_7, v_2, student_t_tables);
    float _e10 = student_t_lobe_masking(lobe_7, l_1, student_t_tables);
    float _e11 = student_t_impl_weight(_e9, _e10, masking_3);
    return _e11;
}

inline metal::float2 student_t_lobe_eval_pdf(
    StudentTLobe lobe_8,
    metal::float3 v_3,
    metal::float3 l_2,
    uint masking_4,
    device const metal::float2* student_t_tables
) {
    bool local_6 = {};
    if (v_3.z > 0.0) {
        local_6 = l_2.z > 0.0;
    } else {
        local_6 = false;
    }
    bool _e13 = local_6;
    if (!(_e13)) {
        return metal::float2(0.0);
    }
    metal::float3 both_1 = v_3 + l_2;
    metal::float3 m_10 = metal::float3(both_1.xy, metal::max(both_1.z, 0.00000000000000000007666467));
    StudentTImplDirection _e24 = student_t_impl_stretch(lobe_8.sigma, v_3);
    float _e25 = student_t_impl_inverse_area(lobe_8, _e24, student_t_tables);
    float _e29 = student_t_impl_min(_e24.z * _e25, 1.0);
    float _e30 = student_t_lobe_masking(lobe_8, l_2, student_t_tables);
    float _e31 = student_t_impl_weight(_e29, _e30, masking_4);
    float _e32 = student_t_impl_dot(m_10, m_10);
    float _e33 = student_t_impl_d(lobe_8, m_10, _e32);
    float density = 0.25 * _e33;
    float _e36 = student_t_impl_product(density, _e25);
    float _e43 = student_t_impl_product(_e31 * _e36, 1.0 / metal::max(l_2.z, 0.0000000000000000000000000000000000001));
    return metal::float2(_e43, _e36);
}

inline bool student_t_effectively_smooth(
    StudentTLobe lobe_9,
    device const metal::float2* student_t_tables
) {
    bool local_7 = {};
    float sigma_20 = metal::max(lobe_9.sigma.x, lobe_9.sigma.y);
    if (!(((0.56 * sigma_20) < 0.001))) {
        return false;
    }
    StudentTImplDirection level = StudentTImplDirection {metal::float2(0.0), 1.0, 1.0, 0.0, 1.0};
    float _e19 = student_t_impl_inverse_area(lobe_9, level, student_t_tables);
    float mean = 2.0 / _e19;
    float rho_1 = 0.99995 * sigma_20;
    StudentTImplDirection grazing = StudentTImplDirection {metal::float2(0.0), 1.0, rho_1, 0.01, rho_1 * rho_1};
    if ((sigma_20 * mean) < 0.001) {
        float _e35 = student_t_impl_inverse_area(lobe_9, grazing, student_t_tables);
        local_7 = (1.0 - (0.01 * _e35)) <= 0.0025;
    } else {
        local_7 = false;
    }
    bool _e43 = local_7;
    return _e43;
}

inline float student_t_impl_sine(
    float x_5
) {
    float y_1 = x_5 * x_5;
    float tail_2 = y_1 * (81.60248 + (y_1 * (-76.58117 + (y_1 * 39.759827))));
    return x_5 * (6.2831855 + (y_1 * (-41.34168 + tail_2)));
}

inline metal::float2 student_t_impl_turn(
    float u
) {
    float x_7 = 0.5 - u;
    float quarter = metal::abs(x_7) - 0.25;
    float rest_1 = 0.25 - metal::abs(quarter);
    float _e9 = student_t_impl_sine(quarter);
    float _e14 = student_t_impl_sine((x_7 < 0.0) ? -(rest_1) : rest_1);
    return metal::float2(_e9, _e14);
}

inline metal::float3 student_t_impl_sample_cap(
    metal::float2 sigma_3,
    metal::float3 v_4,
    metal::float2 u_1
) {
    metal::float3 w_4 = {};
    float tall = {};
    float _e6 = student_t_impl_max(v_4.z, 0.0);
    metal::float3 above = metal::float3(v_4.xy, _e6);
    w_4 = metal::float3(sigma_3 * above.xy, above.z);
    metal::float3 _e13 = w_4;
    metal::float3 _e14 = w_4;
    float _e15 = student_t_impl_dot(_e13, _e14);
    tall = metal::sqrt(_e15);
    float _e18 = tall;
    if (!((_e18 >= 0.000001))) {
        metal::float3 _e26 = w_4;
        float _e27 = tall;
        float _e32 = tall;
        w_4 = (_e32 > 0.0) ? (_e26 / metal::float3(metal::max(_e27, 0.0000000000000000000000000000000000001))) : metal::float3(0.0, 0.0, 1.0);
        tall = 1.0;
    }
    float _e38 = student_t_impl_unit(u_1.x);
    float _e43 = tall;
    float _e45 = w_4.z;
    float height = metal::max(1.0 - _e38, 0.000000059604645) * (_e43 + _e45);
    float _e49 = w_4.z;
    float up_1 = height - _e49;
    float _e51 = tall;
    float _e53 = tall;
    float radius = metal::sqrt(metal::max((_e51 - up_1) * (_e53 + up_1), 0.0));
    metal::float3 _e59 = w_4;
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
    StudentTLobe lobe_10,
    float number
) {
    float _e4 = student_t_impl_log(metal::max(number, 0.0000000000000000000000000000000000001));
    float power_1 = metal::max(_e4 * lobe_10.heavy_exponent, -69.3);
    float zeta = metal::exp(power_1);
    float large = metal::max(zeta, 0.000000000000001);
    float _e14 = student_t_impl_exp_growth(2.0 * power_1);
    float x_8 = 0.5 * metal::sqrt(metal::max(-(_e14), 0.0));
    float z = large * lobe_10.heavy_root_s;
    return StudentTImplHalfSlope {x_8, z, 1.0, zeta / large, x_8 + z};
}

inline float student_t_impl_along_at(
    StudentTLobe lobe_11,
    StudentTImplPlace view,
    uint second,
    StudentTImplPlace number_1,
    device const metal::float2* student_t_tables
) {
    metal::float2 a_6 = {};
    metal::float2 b_6 = {};
    uint numbers = student_t_impl_f2u32(lobe_11.numbers);
    uint low = (lobe_11.slopes + (((2u * view.cell) + second) * numbers)) + number_1.cell;
    uint high = low + (2u * numbers);
    metal::float2 _e18 = student_t_impl_pair(low, student_t_tables);
    a_6 = _e18;
    metal::float2 _e22 = student_t_impl_pair(low + 1u, student_t_tables);
    b_6 = _e22;
    metal::float2 _e24 = a_6;
    metal::float2 _e26 = student_t_impl_pair(high, student_t_tables);
    metal::float2 _e27 = a_6;
    a_6 = _e24 + (view.position * (_e26 - _e27));
    metal::float2 _e31 = b_6;
    metal::float2 _e35 = student_t_impl_pair(high + 1u, student_t_tables);
    metal::float2 _e36 = b_6;
    b_6 = _e31 + (view.position * (_e35 - _e36));
    metal::float2 _e40 = a_6;
    metal::float2 _e41 = b_6;
    float _e43 = student_t_impl_hermite(_e40, _e41, number_1.position);
    return _e43;
}

inline StudentTImplHalfSlope student_t_impl_table_slope(
    StudentTLobe lobe_12,
    float along,
    float at_2,
    float silhouette,
    device const metal::float2* student_t_tables
) {
    bool second_1 = along > 0.5;
    StudentTImplPlace _e7 = student_t_impl_place(at_2, lobe_12.rows);
    float _e8 = student_t_impl_end(along);
    StudentTImplPlace _e14 = student_t_impl_place(_e8 * lobe_12.along_scale, lobe_12.numbers - 1.0);
    float _e16 = student_t_impl_along_at(lobe_12, _e7, static_cast<uint>(second_1), _e14, student_t_tables);
    float sign = second_1 ? -1.0 : 1.0;
    float clear = _e16 - (second_1 ? 0.0 : silhouette);
    return StudentTImplHalfSlope {_e16 - 1.0, _e16 * (2.0 - _e16), sign, 1.0, clear};
}

inline float student_t_impl_across_at(
    StudentTLobe lobe_13,
    StudentTImplPlace place_2,
    device const metal::float2* student_t_tables
) {
    float _e3 = student_t_impl_cubic(lobe_13.across, place_2, student_t_tables);
    return _e3;
}

inline metal::float2 student_t_impl_share_at(
    StudentTLobe lobe_14,
    StudentTImplPlace place_3,
    device const metal::float2* student_t_tables
) {
    float _e3 = student_t_impl_cubic(lobe_14.heavy, place_3, student_t_tables);
    return metal::float2(_e3, 1.0 - _e3);
}

inline metal::float3 student_t_impl_sample_tables(
    StudentTLobe lobe_15,
    metal::float3 v_5,
    metal::float2 u_3,
    device const metal::float2* student_t_tables
) {
    float rest = {};
    float along_1 = {};
    bool is_heavy = false;
    float number_2 = 1.0;
    StudentTImplHalfSlope slope = {};
    float _e4 = student_t_impl_end(u_3.y);
    StudentTImplPlace _e12 = student_t_impl_place(_e4 * lobe_15.across_scale, (0.8408964 * lobe_15.across_scale) + 0.5);
    float _e13 = student_t_impl_across_at(lobe_15, _e12, student_t_tables);
    float t = (u_3.y > 0.5) ? (1.0 - _e13) : (_e13 - 1.0);
    float tz = _e13 * (2.0 - _e13);
    StudentTImplDirection _e26 = student_t_impl_stretch(lobe_15.sigma, v_5);
    float tall_2 = metal::sqrt(_e26.square + (_e26.z * _e26.z));
    rest = 1.0 - (_e26.z / (_e26.rho + tall_2));
    if (lobe_15.heavy_per_row > 0.0) {
        float steep = tall_2 + _e26.z;
        rest = (_e26.rho * (steep + _e26.rho)) / (steep * (_e26.rho + tall_2));
    }
    float _e53 = rest;
    float _e54 = student_t_impl_unit(_e53);
    float at_6 = metal::max(metal::max(lobe_15.rows_first - (lobe_15.rows_first * _e54), lobe_15.rows_second_end - (lobe_15.rows_second * _e54)), lobe_15.rows - (lobe_15.rows_third * _e54));
    float _e70 = student_t_impl_unit(u_3.x);
    along_1 = _e70;
    if (lobe_15.heavy_per_row > 0.0) {
        float cells = lobe_15.heavy_per_row;
        StudentTImplPlace _e83 = student_t_impl_place(at_6 * cells, lobe_15.rows * cells);
        metal::float2 _e84 = student_t_impl_share_at(lobe_15, _e83, student_t_tables);
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
        StudentTImplHalfSlope _e102 = student_t_impl_heavy_slope(lobe_15, _e101);
        slope = _e102;
    } else {
        float _e103 = along_1;
        StudentTImplHalfSlope _e104 = student_t_impl_table_slope(lobe_15, _e103, at_6, _e54, student_t_tables);
        slope = _e104;
    }
    float _e106 = slope.z;
    float _e108 = slope.z;
    float _e114 = slope.x;
    float _e116 = slope.x;
    float norm = metal::sqrt((_e106 * _e108) + ((4.0 * lobe_15.s) * (_e114 * _e116)));
    float _e122 = slope.x;
    float _e124 = slope.sign;
    float ahead = _e122 * (_e124 * tz);
    float aside = norm * t;
    metal::float2 turned = metal::float2((ahead * _e26.xy.x) - (aside * _e26.xy.y), (ahead * _e26.xy.y) + (aside * _e26.xy.x));
    float _e146 = slope.z;
    float _e154 = slope.shrink;
    metal::float3 _e155 = student_t_impl_raise(metal::float3(lobe_15.sigma * turned, _e146 * (0.5 * (_e26.frame * tz))), _e154);
    float _e157 = slope.clear;
    if (!(((_e157 * tz) >= ((0.00001 * tz) + (0.00002 * metal::abs(t)))))) {
        metal::float3 _e170 = student_t_impl_face(metal::float3(v_5.xy, _e26.z), _e155);
        return _e170;
    }
    return _e155;
}

inline metal::float3 student_t_lobe_sample_visible_normal(
    StudentTLobe lobe_16,
    metal::float3 v_6,
    metal::float2 u_4,
    device const metal::float2* student_t_tables
) {
    if (lobe_16.is_ggx > 0.0) {
        metal::float3 _e7 = student_t_impl_sample_cap(lobe_16.sigma, v_6, u_4);
        return _e7;
    }
    metal::float3 _e8 = student_t_impl_sample_tables(lobe_16, v_6, u_4, student_t_tables);
    return _e8;
}

inline float student_t_lobe_visible_normal_pdf(
    StudentTLobe lobe_17,
    metal::float3 v_7,
    metal::float3 m_4,
    device const metal::float2* student_t_tables
) {
    float _e3 = student_t_impl_dot(v_7, m_4);
    float _e5 = student_t_impl_max(_e3, 0.0);
    float _e6 = student_t_lobe_d(lobe_17, m_4);
    float density_1 = _e5 * _e6;
    StudentTImplDirection _e9 = student_t_impl_stretch(lobe_17.sigma, v_7);
    float _e10 = student_t_impl_inverse_area(lobe_17, _e9, student_t_tables);
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
    StudentTLobe lobe_18,
    metal::float3 v_9,
    metal::float3 m_6,
    device const metal::float2* student_t_tables
) {
    float _e3 = student_t_impl_dot(v_9, m_6);
    if (!((_e3 > 0.0))) {
        return 0.0;
    }
    float _e8 = student_t_lobe_d(lobe_18, m_6);
    float density_2 = 0.25 * _e8;
    StudentTImplDirection _e12 = student_t_impl_stretch(lobe_18.sigma, v_9);
    float _e13 = student_t_impl_inverse_area(lobe_18, _e12, student_t_tables);
    float _e14 = student_t_impl_product(density_2, _e13);
    return _e14;
}

inline float student_t_impl_tail(
    float gamma
) {
    float _e2 = student_t_impl_max(gamma, 1.501);
    float _e4 = student_t_impl_min(_e2, 1000000000000.0);
    return 1.0 / (_e4 - 1.0);
}

inline float student_t_impl_facing_pdf(
    float slope2_,
    float sigma_4,
    float s
) {
    float x_9 = (slope2_ / sigma_4) / sigma_4;
    float _e11 = student_t_impl_log_growth(s * x_9);
    float power_2 = metal::exp(-((1.0 + (1.0 / s))) * _e11);
    float scale_1 = (1.0 + slope2_) / sigma_4;
    float _e18 = student_t_impl_product(power_2 * scale_1, scale_1);
    float _e20 = student_t_impl_product(_e18, 0.07957747);
    return _e20;
}

inline metal::float4 student_t_prefilter_light(
    metal::float2 u_5,
    float sigma_5,
    float gamma_1
) {
    float _e3 = student_t_impl_tail(gamma_1);
    float _e4 = student_t_impl_sigma(sigma_5);
    float _e6 = student_t_impl_unit(u_5.x);
    float _e8 = student_t_impl_min(_e6, 0.99999994);
    float _e11 = student_t_impl_log_growth(-(_e8));
    float _e13 = student_t_impl_exp_growth(-(_e3) * _e11);
    float slope_2 = _e4 * metal::sqrt(_e13 / _e3);
    float slope_2_ = slope_2 * slope_2;
    float secant_2_ = 1.0 + slope_2_;
    float sine = (2.0 * slope_2) / secant_2_;
    float _e24 = student_t_impl_unit(u_5.y);
    metal::float2 _e25 = student_t_impl_turn(_e24);
    float _e26 = student_t_impl_facing_pdf(slope_2_, _e4, _e3);
    return metal::float4(sine * _e25, (1.0 - slope_2_) / secant_2_, _e26);
}

inline float student_t_prefilter_pdf(
    float cos_theta,
    float sigma_6,
    float gamma_2
) {
    float _e3 = student_t_impl_unit(cos_theta);
    if (!((cos_theta > 0.0))) {
        return 0.0;
    }
    float _e8 = student_t_impl_tail(gamma_2);
    float _e14 = student_t_impl_sigma(sigma_6);
    float _e15 = student_t_impl_facing_pdf((1.0 - _e3) / (1.0 + _e3), _e14, _e8);
    return _e15;
}

inline metal::float3 student_t_impl_mirror(
    float mu
) {
    float k = 1.0 - mu;
    float fourth = (k * k) * (k * k);
    return metal::float3(0.0, fourth * k, (17.651384 * mu) * (fourth * (k * k)));
}

inline metal::float3 student_t_impl_mirror_average(
) {
    return metal::float3(0.0, 0.04761905, 0.14009036);
}

inline metal::float3 student_t_impl_limit(
    metal::float3 moments
) {
    float _e3 = student_t_impl_max(moments.y, 0.0);
    float _e5 = student_t_impl_min(_e3, moments.x);
    float _e9 = student_t_impl_unit(moments.z);
    return metal::float3(moments.x - _e5, _e5, _e9);
}

inline StudentTImplAlbedo student_t_impl_albedo_of(
    StudentTLobe lobe_19,
    uint masking_5,
    device const metal::float2* student_t_tables
) {
    bool local_8 = {};
    StudentTAlbedoTable _e3 = student_t_impl_albedo_table(lobe_19.shape, masking_5, student_t_tables);
    float stand_in = metal::sqrt(lobe_19.sigma.x * lobe_19.sigma.y);
    float _e11 = student_t_impl_max(stand_in, _e3.sigma_min);
    float _e13 = student_t_impl_min(_e11, _e3.sigma_max);
    float lowest = (_e3.floor * (_e3.slope * _e13)) / (_e3.floor + (_e3.slope * _e13));
    float _e25 = student_t_impl_log_growth(_e13 / _e3.offset);
    float coordinate = (_e25 + (_e3.slow * metal::log(_e13 / _e3.first))) + (_e3.linear * _e13);
    if (!(lobe_19.is_mirror)) {
        local_8 = _e3.values == lobe_19.shape;
    } else {
        local_8 = true;
    }
    bool mirror = local_8;
    return StudentTImplAlbedo {_e3, mirror ? 0.0 : _e13, (coordinate - _e3.start) / _e3.range, lowest};
}

inline float student_t_impl_view(
    StudentTImplAlbedo a_7,
    float mu_1
) {
    float sine_1 = metal::sqrt(metal::max((1.0 - mu_1) * (1.0 + mu_1), 0.0));
    float x_10 = mu_1 / (mu_1 + ((a_7.table.kappa * a_7.sigma) * sine_1));
    float h = mu_1 / (1.0 + sine_1);
    float nu = a_7.table.spread * a_7.sigma;
    float roots = (a_7.table.share * metal::sqrt(metal::sqrt(x_10))) + ((1.0 - a_7.table.share) * metal::sqrt(metal::sqrt(h)));
    return ((a_7.table.weight * x_10) + (a_7.table.normal * (nu / (nu + sine_1)))) + (((1.0 - a_7.table.weight) - a_7.table.normal) * roots);
}

inline StudentTImplSix student_t_impl_six(
    float x_6,
    float n
) {
    float _e3 = student_t_impl_max(x_6, 0.0);
    float _e6 = student_t_impl_min(_e3, n - 1.0);
    float start = metal::max(metal::min(metal::floor(_e6) - 2.0, n - 6.0), 0.0);
    float a_12 = _e6 - start;
    float b_7 = a_12 - 1.0;
    float c = a_12 - 2.0;
    float d_1 = a_12 - 3.0;
    float e = a_12 - 4.0;
    float f = a_12 - 5.0;
    metal::float3 first = metal::float3((b_7 * c) * -0.008333334, (a_12 * c) * 0.041666668, (a_12 * b_7) * -0.083333336);
    metal::float3 last_1 = metal::float3((e * f) * 0.083333336, (d_1 * f) * -0.041666668, (d_1 * e) * 0.008333334);
    return StudentTImplSix {student_t_impl_f2u32(start), {}, ((d_1 * e) * f) * first, ((a_12 * b_7) * c) * last_1};
}

inline metal::float3 student_t_impl_node(
    uint at_3,
    device const metal::float2* student_t_tables
) {
    metal::float2 _e1 = student_t_impl_pair(at_3, student_t_tables);
    metal::float2 _e4 = student_t_impl_pair(at_3 + 1u, student_t_tables);
    return metal::float3(_e1, _e4.x);
}

inline metal::float3 student_t_impl_row(
    uint at_4,
    StudentTImplSix six,
    metal::float3 less,
    device const metal::float2* student_t_tables
) {
    metal::float3 _e3 = student_t_impl_node(at_4, student_t_tables);
    metal::float3 _e10 = student_t_impl_node(at_4 + 2u, student_t_tables);
    metal::float3 _e18 = student_t_impl_node(at_4 + 4u, student_t_tables);
    metal::float3 _e26 = student_t_impl_node(at_4 + 6u, student_t_tables);
    metal::float3 _e33 = student_t_impl_node(at_4 + 8u, student_t_tables);
    metal::float3 _e41 = student_t_impl_node(at_4 + 10u, student_t_tables);
    return ((((_e3 - less) * six.a.x) + ((_e10 - less) * six.a.y)) + ((_e18 - less) * six.a.z)) + ((((_e26 - less) * six.b.x) + ((_e33 - less) * six.b.y)) + ((_e41 - less) * six.b.z));
}

inline metal::float3 student_t_impl_moments_at(
    StudentTImplAlbedo a_8,
    float mu_2,
    device const metal::float2* student_t_tables
) {
    float _e3 = student_t_impl_view(a_8, a_8.lowest);
    float _e4 = student_t_impl_view(a_8, mu_2);
    float at_7 = (_e4 - _e3) / (1.0 - _e3);
    StudentTImplSix _e17 = student_t_impl_six(a_8.coordinate * (a_8.table.sigmas - 1.0), a_8.table.sigmas);
    StudentTImplSix _e25 = student_t_impl_six(at_7 * (a_8.table.views - 1.0), a_8.table.views);
    uint row = 2u * student_t_impl_f2u32(a_8.table.views);
    uint first_1 = (a_8.table.values + (_e17.start * row)) + (2u * _e25.start);
    metal::float3 _e45 = student_t_impl_node((first_1 + (2u * row)) + 4u, student_t_tables);
    metal::float3 _e46 = student_t_impl_row(first_1, _e25, _e45, student_t_tables);
    metal::float3 _e51 = student_t_impl_row(first_1 + row, _e25, _e45, student_t_tables);
    metal::float3 _e59 = student_t_impl_row(first_1 + (2u * row), _e25, _e45, student_t_tables);
    metal::float3 _e67 = student_t_impl_row(first_1 + (3u * row), _e25, _e45, student_t_tables);
    metal::float3 _e74 = student_t_impl_row(first_1 + (4u * row), _e25, _e45, student_t_tables);
    metal::float3 _e82 = student_t_impl_row(first_1 + (5u * row), _e25, _e45, student_t_tables);
    metal::float3 sum_1 = (((_e46 * _e17.a.x) + (_e51 * _e17.a.y)) + (_e59 * _e17.a.z)) + (((_e67 * _e17.b.x) + (_e74 * _e17.b.y)) + (_e82 * _e17.b.z));
    metal::float3 moments_1 = _e45 + sum_1;
    float _e91 = student_t_impl_max(moments_1.x, -1.0);
    float _e93 = student_t_impl_min(_e91, 0.0);
    metal::float3 _e98 = student_t_impl_mirror(mu_2);
    return metal::float3(_e93, moments_1.yz) + ((1.0 + _e93) * _e98);
}

inline metal::float3 student_t_impl_moments(
    StudentTImplAlbedo a_9,
    float cos_theta_1,
    uint masking_6,
    device const metal::float2* student_t_tables
) {
    float power = 1.0;
    float more = 0.0;
    float nearer = 1.0;
    float _e3 = student_t_impl_unit(cos_theta_1);
    if (!((a_9.sigma > 0.0))) {
        metal::float3 _e8 = student_t_impl_mirror(_e3);
        return _e8;
    }
    metal::float3 _e11 = student_t_impl_moments_at(a_9, metal::max(_e3, a_9.lowest), student_t_tables);
    if (!((_e3 < a_9.lowest))) {
        return _e11;
    }
    if (!((_e11.x < 0.0))) {
        metal::float3 _e19 = student_t_impl_mirror(_e3);
        return _e19;
    }
    metal::float3 _e23 = student_t_impl_moments_at(a_9, 4.0 * a_9.lowest, student_t_tables);
    if (masking_6 != STUDENT_T_UNCORRELATED) {
        float ratio = _e23.x / _e11.x;
        power = 0.0;
        if (ratio > 1.0) {
            float _e34 = student_t_impl_log(ratio);
            power = metal::min(0.7213475 * _e34, 1.0);
        }
    }
    float _e41 = power;
    if (_e41 > 0.0) {
        if (_e3 > 0.0) {
            float _e48 = power;
            float _e53 = student_t_impl_exp_growth(_e48 * metal::log(_e3 / a_9.lowest));
            nearer = -(_e53);
        }
        float _e55 = nearer;
        float _e56 = power;
        float _e59 = student_t_impl_exp_growth(_e56 * 1.3862944);
        more = _e55 / _e59;
    }
    float _e61 = more;
    metal::float3 limit = _e11 + (_e61 * (_e11 - _e23));
    float _e67 = student_t_impl_max(limit.x, -1.0);
    float _e69 = student_t_impl_min(_e67, 0.0);
    return metal::float3(_e69, limit.yz);
}

inline float student_t_impl_lost(
    StudentTImplAlbedo a_10,
    float cos_theta_2,
    uint masking_7,
    device const metal::float2* student_t_tables
) {
    metal::float3 _e3 = student_t_impl_moments(a_10, cos_theta_2, masking_7, student_t_tables);
    return -(_e3.x);
}

inline float student_t_lobe_albedo(
    StudentTLobe lobe_20,
    float cos_theta_3,
    uint masking_8,
    device const metal::float2* student_t_tables
) {
    StudentTImplAlbedo _e3 = student_t_impl_albedo_of(lobe_20, masking_8, student_t_tables);
    float _e4 = student_t_impl_lost(_e3, cos_theta_3, masking_8, student_t_tables);
    return 1.0 - _e4;
}

inline metal::float3 student_t_lobe_albedo_parts(
    StudentTLobe lobe_21,
    float cos_theta_4,
    uint masking_9,
    device const metal::float2* student_t_tables
) {
    StudentTImplAlbedo _e3 = student_t_impl_albedo_of(lobe_21, masking_9, student_t_tables);
    metal::float3 _e4 = student_t_impl_moments(_e3, cos_theta_4, masking_9, student_t_tables);
    metal::float3 _e10 = student_t_impl_limit(metal::float3(1.0 + _e4.x, _e4.yz));
    return _e10;
}

inline metal::float3 student_t_impl_averages(
    StudentTImplAlbedo a_11,
    device const metal::float2* student_t_tables
) {
    if (!((a_11.sigma > 0.0))) {
        metal::float3 _e5 = student_t_impl_mirror_average();
        return _e5;
    }
    float count = a_11.table.average_sigmas;
    StudentTImplSix _e12 = student_t_impl_six(a_11.coordinate * (count - 1.0), count);
    metal::float3 _e21 = student_t_impl_row(a_11.table.averages + (2u * _e12.start), _e12, metal::float3(0.0), student_t_tables);
    return metal::float3(metal::min(metal::exp(_e21.x), 1.0), _e21.yz);
}

inline float student_t_lobe_albedo_average(
    StudentTLobe lobe_22,
    uint masking_10,
    device const metal::float2* student_t_tables
) {
    StudentTImplAlbedo _e2 = student_t_impl_albedo_of(lobe_22, masking_10, student_t_tables);
    metal::float3 _e3 = student_t_impl_averages(_e2, student_t_tables);
    return 1.0 - _e3.x;
}

inline metal::float3 student_t_lobe_albedo_average_parts(
    StudentTLobe lobe_23,
    uint masking_11,
    device const metal::float2* student_t_tables
) {
    StudentTImplAlbedo _e2 = student_t_impl_albedo_of(lobe_23, masking_11, student_t_tables);
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
    StudentTLobe lobe_24,
    metal::float3 v_10,
    metal::float3 l_3,
    uint masking_12,
    device const metal::float2* student_t_tables
) {
    bool local_9 = {};
    if (v_10.z > 0.0) {
        local_9 = l_3.z > 0.0;
    } else {
        local_9 = false;
    }
    bool _e13 = local_9;
    if (!(_e13)) {
        return 0.0;
    }
    StudentTImplAlbedo _e16 = student_t_impl_albedo_of(lobe_24, masking_12, student_t_tables);
    float _e18 = student_t_impl_lost(_e16, v_10.z, masking_12, student_t_tables);
    float _e20 = student_t_impl_lost(_e16, l_3.z, masking_12, student_t_tables);
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

inline float student_t_d(
    uint shape_2,
    metal::float2 sigma_7,
    metal::float3 m_7,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e3 = student_t_lobe_of(shape_2, sigma_7, student_t_tables);
    float _e4 = student_t_lobe_d(_e3, m_7);
    return _e4;
}

inline float student_t_masking(
    uint shape_3,
    metal::float2 sigma_8,
    metal::float3 w_5,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e3 = student_t_lobe_of(shape_3, sigma_8, student_t_tables);
    float _e4 = student_t_lobe_masking(_e3, w_5, student_t_tables);
    return _e4;
}

inline float student_t_lambda(
    uint shape_4,
    metal::float2 sigma_9,
    metal::float3 w_6,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e3 = student_t_lobe_of(shape_4, sigma_9, student_t_tables);
    float _e4 = student_t_lobe_lambda(_e3, w_6, student_t_tables);
    return _e4;
}

inline float student_t_masking_shadowing(
    uint shape_5,
    metal::float2 sigma_10,
    metal::float3 v_11,
    metal::float3 l_4,
    uint masking_13,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e5 = student_t_lobe_of(shape_5, sigma_10, student_t_tables);
    float _e6 = student_t_lobe_masking_shadowing(_e5, v_11, l_4, masking_13, student_t_tables);
    return _e6;
}

inline float student_t_reflection_weight(
    uint shape_6,
    metal::float2 sigma_11,
    metal::float3 v_12,
    metal::float3 l_5,
    uint masking_14,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e5 = student_t_lobe_of(shape_6, sigma_11, student_t_tables);
    float _e6 = student_t_lobe_reflection_weight(_e5, v_12, l_5, masking_14, student_t_tables);
    return _e6;
}

inline metal::float3 student_t_sample_visible_normal(
    uint shape_7,
    metal::float2 sigma_12,
    metal::float3 v_13,
    metal::float2 u_6,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e4 = student_t_lobe_of(shape_7, sigma_12, student_t_tables);
    metal::float3 _e5 = student_t_lobe_sample_visible_normal(_e4, v_13, u_6, student_t_tables);
    return _e5;
}

inline float student_t_visible_normal_pdf(
    uint shape_8,
    metal::float2 sigma_13,
    metal::float3 v_14,
    metal::float3 m_8,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e4 = student_t_lobe_of(shape_8, sigma_13, student_t_tables);
    float _e5 = student_t_lobe_visible_normal_pdf(_e4, v_14, m_8, student_t_tables);
    return _e5;
}

inline float student_t_reflection_pdf(
    uint shape_9,
    metal::float2 sigma_14,
    metal::float3 v_15,
    metal::float3 m_9,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e4 = student_t_lobe_of(shape_9, sigma_14, student_t_tables);
    float _e5 = student_t_lobe_reflection_pdf(_e4, v_15, m_9, student_t_tables);
    return _e5;
}

inline float student_t_albedo(
    uint shape_10,
    metal::float2 sigma_15,
    float cos_theta_5,
    uint masking_15,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e4 = student_t_lobe_of(shape_10, sigma_15, student_t_tables);
    float _e5 = student_t_lobe_albedo(_e4, cos_theta_5, masking_15, student_t_tables);
    return _e5;
}

inline metal::float3 student_t_albedo_parts(
    uint shape_11,
    metal::float2 sigma_16,
    float cos_theta_6,
    uint masking_16,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e4 = student_t_lobe_of(shape_11, sigma_16, student_t_tables);
    metal::float3 _e5 = student_t_lobe_albedo_parts(_e4, cos_theta_6, masking_16, student_t_tables);
    return _e5;
}

inline float student_t_albedo_average(
    uint shape_12,
    metal::float2 sigma_17,
    uint masking_17,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e3 = student_t_lobe_of(shape_12, sigma_17, student_t_tables);
    float _e4 = student_t_lobe_albedo_average(_e3, masking_17, student_t_tables);
    return _e4;
}

inline metal::float3 student_t_albedo_average_parts(
    uint shape_13,
    metal::float2 sigma_18,
    uint masking_18,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e3 = student_t_lobe_of(shape_13, sigma_18, student_t_tables);
    metal::float3 _e4 = student_t_lobe_albedo_average_parts(_e3, masking_18, student_t_tables);
    return _e4;
}

inline float student_t_compensation(
    uint shape_14,
    metal::float2 sigma_19,
    metal::float3 v_16,
    metal::float3 l_6,
    uint masking_19,
    device const metal::float2* student_t_tables
) {
    StudentTLobe _e5 = student_t_lobe_of(shape_14, sigma_19, student_t_tables);
    float _e6 = student_t_lobe_compensation(_e5, v_16, l_6, masking_19, student_t_tables);
    return _e6;
}

#endif
