#ifndef STUDENT_T
#define STUDENT_T

#ifndef STUDENT_T_BINDING
#define STUDENT_T_BINDING layout(std430, binding = 0)
#endif

struct StudentTShape {
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
    float floor_;
    float slope;
};
struct StudentTImplPlace {
    uint cell;
    float position;
};
struct StudentTImplDirection {
    vec2 xy;
    float frame;
    float rho;
    float z;
    float square;
};
struct StudentTImplHalfSlope {
    float x;
    float z;
    float sign_;
    float shrink;
    float clear;
};
struct StudentTImplSix {
    uint start;
    vec3 a;
    vec3 b;
};
struct StudentTImplAlbedo {
    StudentTAlbedoTable table;
    float sigma;
    float coordinate;
    float lowest;
};
const uint STUDENT_T_UNCORRELATED = 0u;
const uint STUDENT_T_HEIGHT_CORRELATED = 1u;

STUDENT_T_BINDING readonly buffer student_t_tables_block { vec2 student_t_tables[]; };


vec2 student_t_impl_pair(uint at) {
    vec2 _e3 = student_t_tables[at];
    return _e3;
}

StudentTShape student_t_impl_shape(uint shape) {
    vec2 _e3 = student_t_impl_pair((shape + 0u));
    vec2 _e6 = student_t_impl_pair((shape + 1u));
    vec2 _e9 = student_t_impl_pair((shape + 2u));
    vec2 _e12 = student_t_impl_pair((shape + 3u));
    vec2 _e15 = student_t_impl_pair((shape + 4u));
    vec2 _e18 = student_t_impl_pair((shape + 5u));
    vec2 _e21 = student_t_impl_pair((shape + 6u));
    vec2 _e24 = student_t_impl_pair((shape + 7u));
    vec2 _e27 = student_t_impl_pair((shape + 8u));
    vec2 _e30 = student_t_impl_pair((shape + 9u));
    vec2 _e33 = student_t_impl_pair((shape + 10u));
    return StudentTShape(_e3.x, _e3.y, _e6.x, _e6.y, _e9.x, _e9.y, _e12.x, (shape + uint(_e12.y)), _e15.x, _e15.y, _e18.x, _e18.y, _e21.x, _e21.y, _e24.x, (shape + uint(_e24.y)), _e27.x, (shape + uint(_e27.y)), _e30.x, (shape + uint(_e30.y)), _e33.x, _e33.y);
}

StudentTAlbedoTable student_t_impl_albedo_table(uint shape_1, uint masking) {
    uint at_4 = (shape_1 + ((masking == STUDENT_T_UNCORRELATED) ? 11u : 21u));
    vec2 _e10 = student_t_impl_pair((at_4 + 0u));
    vec2 _e13 = student_t_impl_pair((at_4 + 1u));
    vec2 _e16 = student_t_impl_pair((at_4 + 2u));
    vec2 _e19 = student_t_impl_pair((at_4 + 3u));
    vec2 _e22 = student_t_impl_pair((at_4 + 4u));
    vec2 _e25 = student_t_impl_pair((at_4 + 5u));
    vec2 _e28 = student_t_impl_pair((at_4 + 6u));
    vec2 _e31 = student_t_impl_pair((at_4 + 7u));
    vec2 _e34 = student_t_impl_pair((at_4 + 8u));
    vec2 _e37 = student_t_impl_pair((at_4 + 9u));
    return StudentTAlbedoTable((shape_1 + uint(_e10.x)), (shape_1 + uint(_e10.y)), _e13.x, _e13.y, _e16.x, _e16.y, _e19.x, _e19.y, _e22.x, _e22.y, _e25.x, _e25.y, _e28.x, _e28.y, _e31.x, _e31.y, _e34.x, _e34.y, _e37.x, _e37.y);
}

float student_t_impl_max(float a, float b) {
    return ((a > b) ? a : b);
}

float student_t_impl_min(float a_1, float b_1) {
    return ((a_1 < b_1) ? a_1 : b_1);
}

float student_t_impl_unit(float x) {
    float _e2 = student_t_impl_max(x, 0.0);
    float _e4 = student_t_impl_min(_e2, 1.0);
    return _e4;
}

float student_t_impl_product(float a_2, float b_2) {
    bool local = false;
    if ((b_2 > 1.0)) {
        local = (a_2 > (3.402823e38 / b_2));
    } else {
        local = false;
    }
    bool _e10 = local;
    if (_e10) {
        return 3.402823e38;
    }
    return (a_2 * b_2);
}

float student_t_impl_sigma(float sigma) {
    float _e2 = student_t_impl_max(sigma, 1e-8);
    float _e4 = student_t_impl_min(_e2, 1000000.0);
    return _e4;
}

float student_t_impl_log_growth(float x_1) {
    bool local_1 = false;
    if ((x_1 >= -0.5)) {
        local_1 = (x_1 <= 1.0);
    } else {
        local_1 = false;
    }
    bool _e8 = local_1;
    if (!(_e8)) {
        return log((1.0 + x_1));
    }
    float y = (x_1 / (2.0 + x_1));
    float q = (y * y);
    float tail = (q * (0.11111111 + (q * (0.09090909 + (q * (0.07692308 + (q * 0.06666667)))))));
    return ((2.0 * y) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + tail))))))));
}

float student_t_impl_log(float x_2) {
    bool local_2 = false;
    if ((x_2 >= 0.5)) {
        local_2 = (x_2 <= 2.0);
    } else {
        local_2 = false;
    }
    bool _e8 = local_2;
    if (_e8) {
        float _e11 = student_t_impl_log_growth((x_2 - 1.0));
        return _e11;
    }
    return log(x_2);
}

float student_t_impl_exp_growth(float x_3) {
    if ((abs(x_3) > 0.5)) {
        return (exp(x_3) - 1.0);
    }
    float tail_1 = (0.008333334 + (x_3 * (0.0013888889 + (x_3 * (0.0001984127 + (x_3 * 2.4801588e-5))))));
    return (x_3 * (1.0 + (x_3 * (0.5 + (x_3 * (0.16666667 + (x_3 * (0.041666668 + (x_3 * tail_1)))))))));
}

StudentTImplPlace student_t_impl_place(float x_4, float last) {
    uint cell = min(uint(x_4), uint(last));
    return StudentTImplPlace(cell, (x_4 - float(cell)));
}

float student_t_impl_cubic(uint table, StudentTImplPlace place) {
    vec2 _e6 = student_t_impl_pair((table + (2u * place.cell)));
    vec2 _e13 = student_t_impl_pair(((table + (2u * place.cell)) + 1u));
    float w_6 = place.position;
    return ((_e6.x + (w_6 * _e6.y)) + ((w_6 * w_6) * (_e13.x + (w_6 * _e13.y))));
}

StudentTImplDirection student_t_impl_stretch(vec2 sigma_1, vec3 w) {
    float _e3 = student_t_impl_unit(w.z);
    vec2 xy = (sigma_1 * w.xy);
    float square = ((xy.x * xy.x) + (xy.y * xy.y));
    float rho = sqrt(square);
    if ((rho >= 1e-6)) {
        return StudentTImplDirection(xy, rho, rho, _e3, square);
    } else {
        if ((rho >= 1e-18)) {
            return StudentTImplDirection((xy / vec2(rho)), 1.0, rho, _e3, square);
        }
    }
    float up = ((_e3 > 0.0) ? 1.0 : 0.0);
    return StudentTImplDirection(vec2(1.0, 0.0), 1.0, (1.0 - up), up, (1.0 - up));
}

StudentTImplDirection student_t_impl_stretched(vec2 sigma_2, vec3 w_1) {
    float _e3 = student_t_impl_sigma(sigma_2.x);
    float _e5 = student_t_impl_sigma(sigma_2.y);
    vec2 rough = vec2(_e3, _e5);
    StudentTImplDirection _e7 = student_t_impl_stretch(rough, w_1);
    return _e7;
}

float student_t_impl_inverse_area(StudentTShape shape_2, StudentTImplDirection d) {
    float at_1 = 0.0;
    if ((shape_2.is_ggx > 0.0)) {
        float tall_1 = (d.z + sqrt((d.square + (d.z * d.z))));
        float _e14 = student_t_impl_max(tall_1, 1.1754944e-38);
        return (2.0 / _e14);
    }
    float across = (shape_2.kappa * d.rho);
    float _e23 = student_t_impl_max((d.z + across), 1e-30);
    float r = (shape_2.masking_cells / _e23);
    at_1 = (d.z * r);
    if ((shape_2.masking_crowded > 0.0)) {
        float _e33 = student_t_impl_unit((across / _e23));
        at_1 = ((1.0 - sqrt(_e33)) * shape_2.masking_cells);
    }
    float _e39 = at_1;
    StudentTImplPlace _e41 = student_t_impl_place(_e39, shape_2.masking_cells);
    float _e43 = student_t_impl_cubic(shape_2.masking, _e41);
    return (_e43 * r);
}

float student_t_impl_dot(vec3 a_3, vec3 b_3) {
    return (((a_3.x * b_3.x) + (a_3.y * b_3.y)) + (a_3.z * b_3.z));
}

vec3 student_t_impl_raise(vec3 m, float shrink) {
    float r_1 = (1.0 / sqrt((((m.x * m.x) + (m.z * m.z)) + (m.y * m.y))));
    float _e24 = student_t_impl_max(((m.z * r_1) * shrink), 1e-18);
    return vec3((m.x * r_1), (m.y * r_1), _e24);
}

vec3 student_t_impl_face(vec3 v, vec3 m_1) {
    float _e2 = student_t_impl_dot(v, m_1);
    if ((_e2 < 0.0)) {
        float _e5 = student_t_impl_dot(v, v);
        float _e7 = student_t_impl_max(_e5, 1.1754944e-38);
        vec3 _e12 = student_t_impl_raise((m_1 - ((_e2 / _e7) * v)), 1.0);
        return _e12;
    }
    return m_1;
}

float student_t_impl_d(StudentTShape shape_3, vec2 sigma_3, vec3 m_2) {
    bool local_3 = false;
    float root = 0.0;
    float growth = 0.0;
    float _e4 = student_t_impl_sigma(sigma_3.x);
    float _e6 = student_t_impl_sigma(sigma_3.y);
    vec2 rough_1 = vec2(_e4, _e6);
    vec2 slope_1 = (m_2.xy / rough_1);
    float square_1 = (m_2.z * m_2.z);
    float part = (shape_3.d_s * ((slope_1.x * slope_1.x) + (slope_1.y * slope_1.y)));
    if ((m_2.z > 0.0)) {
        local_3 = (part >= 0.0);
    } else {
        local_3 = false;
    }
    bool _e30 = local_3;
    if (!(_e30)) {
        return 0.0;
    }
    float _e35 = student_t_impl_max((square_1 + part), 1.1754944e-38);
    root = (1.0 / _e35);
    if (!((shape_3.is_ggx > 0.0))) {
        growth = (log(_e35) - (2.0 * log(m_2.z)));
        if ((part < (1000.0 * square_1))) {
            float _e54 = student_t_impl_log_growth((part / square_1));
            growth = _e54;
        }
        float _e55 = root;
        float _e57 = growth;
        root = (_e55 * exp((shape_3.d_power * _e57)));
    }
    float scale = sqrt((1.0 / ((3.1415927 * rough_1.x) * rough_1.y)));
    float _e69 = root;
    float limited = min((scale * min(_e69, 1e30)), 1.8446742e19);
    return (limited * limited);
}

float student_t_d(uint shape_4, vec2 sigma_4, vec3 m_3) {
    StudentTShape _e3 = student_t_impl_shape(shape_4);
    float _e4 = student_t_impl_d(_e3, sigma_4, m_3);
    return _e4;
}

float student_t_impl_masking(StudentTShape shape_5, vec2 sigma_5, vec3 w_2) {
    StudentTImplDirection _e3 = student_t_impl_stretched(sigma_5, w_2);
    float _e5 = student_t_impl_inverse_area(shape_5, _e3);
    float _e8 = student_t_impl_min((_e3.z * _e5), 1.0);
    return _e8;
}

float student_t_masking(uint shape_6, vec2 sigma_6, vec3 w_3) {
    StudentTShape _e3 = student_t_impl_shape(shape_6);
    float _e4 = student_t_impl_masking(_e3, sigma_6, w_3);
    return _e4;
}

float student_t_lambda(uint shape_7, vec2 sigma_7, vec3 w_4) {
    StudentTShape _e3 = student_t_impl_shape(shape_7);
    float _e4 = student_t_impl_masking(_e3, sigma_7, w_4);
    float _e6 = student_t_impl_max(_e4, 1.1754944e-38);
    return ((1.0 / _e6) - 1.0);
}

float student_t_masking_shadowing(uint shape_8, vec2 sigma_8, vec3 v_1, vec3 l, uint masking_1) {
    bool local_4 = false;
    StudentTShape _e5 = student_t_impl_shape(shape_8);
    float _e6 = student_t_impl_masking(_e5, sigma_8, v_1);
    float _e7 = student_t_impl_masking(_e5, sigma_8, l);
    float both = (_e6 * _e7);
    float sum = ((_e6 + _e7) - both);
    if (!((masking_1 == STUDENT_T_UNCORRELATED))) {
        local_4 = !((sum > 0.0));
    } else {
        local_4 = true;
    }
    bool _e20 = local_4;
    if (_e20) {
        return both;
    }
    return (both / sum);
}

float student_t_reflection_weight(uint shape_9, vec2 sigma_9, vec3 v_2, vec3 l_1, uint masking_2) {
    bool local_5 = false;
    StudentTShape _e5 = student_t_impl_shape(shape_9);
    float _e6 = student_t_impl_masking(_e5, sigma_9, l_1);
    if ((v_2.z > 0.0)) {
        local_5 = (_e6 > 0.0);
    } else {
        local_5 = false;
    }
    bool _e15 = local_5;
    if (!(_e15)) {
        return 0.0;
    }
    float _e18 = student_t_impl_masking(_e5, sigma_9, v_2);
    float both_1 = (_e6 + (_e18 * (1.0 - _e6)));
    return (_e6 / ((masking_2 == STUDENT_T_UNCORRELATED) ? 1.0 : both_1));
}

float student_t_impl_sine(float x_5) {
    float y_1 = (x_5 * x_5);
    float tail_2 = (y_1 * (81.60248 + (y_1 * (-76.58117 + (y_1 * 39.759827)))));
    return (x_5 * (6.2831855 + (y_1 * (-41.34168 + tail_2))));
}

vec2 student_t_impl_turn(float u) {
    float x_7 = (0.5 - u);
    float quarter = (abs(x_7) - 0.25);
    float rest_1 = (0.25 - abs(quarter));
    float _e9 = student_t_impl_sine(quarter);
    float _e14 = student_t_impl_sine(((x_7 < 0.0) ? -(rest_1) : rest_1));
    return vec2(_e9, _e14);
}

vec3 student_t_impl_sample_cap(vec2 sigma_10, vec3 v_3, vec2 u_1) {
    vec3 w_5 = vec3(0.0);
    float tall = 0.0;
    float _e6 = student_t_impl_max(v_3.z, 0.0);
    vec3 above = vec3(v_3.xy, _e6);
    w_5 = vec3((sigma_10 * above.xy), above.z);
    vec3 _e13 = w_5;
    vec3 _e14 = w_5;
    float _e15 = student_t_impl_dot(_e13, _e14);
    tall = sqrt(_e15);
    float _e18 = tall;
    if (!((_e18 >= 1e-6))) {
        vec3 _e26 = w_5;
        float _e27 = tall;
        float _e32 = tall;
        w_5 = ((_e32 > 0.0) ? (_e26 / vec3(max(_e27, 1e-37))) : vec3(0.0, 0.0, 1.0));
        tall = 1.0;
    }
    float _e38 = student_t_impl_unit(u_1.x);
    float _e43 = tall;
    float _e45 = w_5.z;
    float height = (max((1.0 - _e38), 5.9604645e-8) * (_e43 + _e45));
    float _e49 = w_5.z;
    float up_1 = (height - _e49);
    float _e51 = tall;
    float _e53 = tall;
    float radius = sqrt(max(((_e51 - up_1) * (_e53 + up_1)), 0.0));
    vec3 _e59 = w_5;
    float _e62 = student_t_impl_unit(u_1.y);
    vec2 _e63 = student_t_impl_turn(_e62);
    vec2 point = (_e59.xy + (radius * _e63));
    vec3 _e69 = student_t_impl_raise(vec3((sigma_10 * point), height), 1.0);
    vec3 _e70 = student_t_impl_face(above, _e69);
    return _e70;
}

float student_t_impl_end(float u_2) {
    float _e3 = student_t_impl_min(u_2, (1.0 - u_2));
    float _e5 = student_t_impl_max(_e3, 0.0);
    return sqrt(sqrt(_e5));
}

StudentTImplHalfSlope student_t_impl_heavy_slope(StudentTShape shape_10, float number) {
    float _e4 = student_t_impl_log(max(number, 1e-37));
    float power_1 = max((_e4 * shape_10.heavy_exponent), -69.3);
    float zeta = exp(power_1);
    float large = max(zeta, 1e-15);
    float _e14 = student_t_impl_exp_growth((2.0 * power_1));
    float x_8 = (0.5 * sqrt(max(-(_e14), 0.0)));
    float z = (large * shape_10.heavy_root_s);
    return StudentTImplHalfSlope(x_8, z, 1.0, (zeta / large), (x_8 + z));
}

StudentTImplHalfSlope student_t_impl_table_slope(StudentTShape shape_11, float along, StudentTImplPlace view, float silhouette) {
    vec2 a_4 = vec2(0.0);
    vec2 b_4 = vec2(0.0);
    bool second = (along > 0.5);
    float _e6 = student_t_impl_end(along);
    StudentTImplPlace _e12 = student_t_impl_place((_e6 * shape_11.along_scale), (shape_11.numbers - 1.0));
    uint numbers = uint(shape_11.numbers);
    uint low = ((shape_11.slopes + (((2u * view.cell) + uint(second)) * numbers)) + _e12.cell);
    uint high = (low + (2u * numbers));
    vec2 _e28 = student_t_impl_pair(low);
    a_4 = _e28;
    vec2 _e32 = student_t_impl_pair((low + 1u));
    b_4 = _e32;
    vec2 _e34 = a_4;
    vec2 _e36 = student_t_impl_pair(high);
    vec2 _e37 = a_4;
    a_4 = (_e34 + (view.position * (_e36 - _e37)));
    vec2 _e41 = b_4;
    vec2 _e45 = student_t_impl_pair((high + 1u));
    vec2 _e46 = b_4;
    b_4 = (_e41 + (view.position * (_e45 - _e46)));
    float w_7 = _e12.position;
    float value_a = (1.0 + (w_7 * (w_7 * ((w_7 * 2.0) - 3.0))));
    float slope_a = (w_7 * (1.0 + (w_7 * (w_7 - 2.0))));
    float value_b = (w_7 * (w_7 * (3.0 - (w_7 * 2.0))));
    float slope_b = (w_7 * (w_7 * (w_7 - 1.0)));
    float _e76 = a_4.x;
    float _e79 = b_4.x;
    float _e83 = a_4.y;
    float _e86 = b_4.y;
    float g = (((_e76 * value_a) + (_e79 * value_b)) + ((_e83 * slope_a) + (_e86 * slope_b)));
    float sign_ = (second ? -1.0 : 1.0);
    float clear = (g - (second ? 0.0 : silhouette));
    return StudentTImplHalfSlope((g - 1.0), (g * (2.0 - g)), sign_, 1.0, clear);
}

vec3 student_t_impl_sample_tables(StudentTShape shape_12, vec2 sigma_11, vec3 v_4, vec2 u_3) {
    float rest = 0.0;
    float along_1 = 0.0;
    bool is_heavy = false;
    float number_1 = 1.0;
    StudentTImplHalfSlope slope = StudentTImplHalfSlope(0.0, 0.0, 0.0, 0.0, 0.0);
    float _e5 = student_t_impl_end(u_3.y);
    StudentTImplPlace _e13 = student_t_impl_place((_e5 * shape_12.across_scale), ((0.8408964 * shape_12.across_scale) + 0.5));
    float _e15 = student_t_impl_cubic(shape_12.across, _e13);
    float t = ((u_3.y > 0.5) ? (1.0 - _e15) : (_e15 - 1.0));
    float tz = (_e15 * (2.0 - _e15));
    StudentTImplDirection _e27 = student_t_impl_stretch(sigma_11, v_4);
    float tall_2 = sqrt((_e27.square + (_e27.z * _e27.z)));
    rest = (1.0 - (_e27.z / (_e27.rho + tall_2)));
    if ((shape_12.heavy_per_row > 0.0)) {
        float steep = (tall_2 + _e27.z);
        rest = ((_e27.rho * (steep + _e27.rho)) / (steep * (_e27.rho + tall_2)));
    }
    float _e54 = rest;
    float _e55 = student_t_impl_unit(_e54);
    float at_5 = max(max((shape_12.rows_first - (shape_12.rows_first * _e55)), (shape_12.rows_second_end - (shape_12.rows_second * _e55))), (shape_12.rows - (shape_12.rows_third * _e55)));
    float _e71 = student_t_impl_unit(u_3.x);
    along_1 = _e71;
    if ((shape_12.heavy_per_row > 0.0)) {
        float cells = shape_12.heavy_per_row;
        StudentTImplPlace _e84 = student_t_impl_place((at_5 * cells), (shape_12.rows * cells));
        float _e86 = student_t_impl_cubic(shape_12.heavy, _e84);
        float rest_2 = (1.0 - _e86);
        float _e89 = along_1;
        is_heavy = (_e89 > rest_2);
        bool _e91 = is_heavy;
        if (_e91) {
            float _e92 = along_1;
            number_1 = min(((1.0 - _e92) / _e86), 1.0);
        }
        float _e98 = along_1;
        along_1 = (_e98 / rest_2);
    }
    bool _e101 = is_heavy;
    if (_e101) {
        float _e102 = number_1;
        StudentTImplHalfSlope _e103 = student_t_impl_heavy_slope(shape_12, _e102);
        slope = _e103;
    } else {
        StudentTImplPlace _e105 = student_t_impl_place(at_5, shape_12.rows);
        float _e106 = along_1;
        StudentTImplHalfSlope _e107 = student_t_impl_table_slope(shape_12, _e106, _e105, _e55);
        slope = _e107;
    }
    float _e109 = slope.z;
    float _e111 = slope.z;
    float _e117 = slope.x;
    float _e119 = slope.x;
    float norm = sqrt(((_e109 * _e111) + ((4.0 * shape_12.s) * (_e117 * _e119))));
    float _e125 = slope.x;
    float _e127 = slope.sign_;
    float ahead = (_e125 * (_e127 * tz));
    float aside = (norm * t);
    vec2 turned = vec2(((ahead * _e27.xy.x) - (aside * _e27.xy.y)), ((ahead * _e27.xy.y) + (aside * _e27.xy.x)));
    float _e148 = slope.z;
    float _e156 = slope.shrink;
    vec3 _e157 = student_t_impl_raise(vec3((sigma_11 * turned), (_e148 * (0.5 * (_e27.frame * tz)))), _e156);
    float _e159 = slope.clear;
    if (!(((_e159 * tz) >= ((1e-5 * tz) + (2e-5 * abs(t)))))) {
        vec3 _e172 = student_t_impl_face(vec3(v_4.xy, _e27.z), _e157);
        return _e172;
    }
    return _e157;
}

vec3 student_t_sample_visible_normal(uint shape_13, vec2 sigma_12, vec3 v_5, vec2 u_4) {
    StudentTShape _e4 = student_t_impl_shape(shape_13);
    float _e6 = student_t_impl_sigma(sigma_12.x);
    float _e8 = student_t_impl_sigma(sigma_12.y);
    vec2 rough_2 = vec2(_e6, _e8);
    if ((_e4.is_ggx > 0.0)) {
        vec3 _e13 = student_t_impl_sample_cap(rough_2, v_5, u_4);
        return _e13;
    }
    vec3 _e14 = student_t_impl_sample_tables(_e4, rough_2, v_5, u_4);
    return _e14;
}

float student_t_visible_normal_pdf(uint shape_14, vec2 sigma_13, vec3 v_6, vec3 m_4) {
    StudentTShape _e4 = student_t_impl_shape(shape_14);
    float _e5 = student_t_impl_dot(v_6, m_4);
    float _e7 = student_t_impl_max(_e5, 0.0);
    float _e8 = student_t_impl_d(_e4, sigma_13, m_4);
    float density = (_e7 * _e8);
    StudentTImplDirection _e10 = student_t_impl_stretched(sigma_13, v_6);
    float _e11 = student_t_impl_inverse_area(_e4, _e10);
    float _e12 = student_t_impl_product(density, _e11);
    return _e12;
}

vec3 student_t_reflect(vec3 v_7, vec3 m_5) {
    float _e2 = student_t_impl_dot(v_7, m_5);
    return (((2.0 * _e2) * m_5) - v_7);
}

float student_t_reflection_pdf(uint shape_15, vec2 sigma_14, vec3 v_8, vec3 m_6) {
    float _e4 = student_t_impl_dot(v_8, m_6);
    if (!((_e4 > 0.0))) {
        return 0.0;
    }
    StudentTShape _e9 = student_t_impl_shape(shape_15);
    float _e10 = student_t_impl_d(_e9, sigma_14, m_6);
    float density_1 = (0.25 * _e10);
    StudentTImplDirection _e13 = student_t_impl_stretched(sigma_14, v_8);
    float _e14 = student_t_impl_inverse_area(_e9, _e13);
    float _e15 = student_t_impl_product(density_1, _e14);
    return _e15;
}

StudentTImplSix student_t_impl_six(float x_6, float n) {
    float _e3 = student_t_impl_max(x_6, 0.0);
    float _e6 = student_t_impl_min(_e3, (n - 1.0));
    float start = max(min((floor(_e6) - 2.0), (n - 6.0)), 0.0);
    float a_9 = (_e6 - start);
    float b_5 = (a_9 - 1.0);
    float c = (a_9 - 2.0);
    float d_1 = (a_9 - 3.0);
    float e = (a_9 - 4.0);
    float f = (a_9 - 5.0);
    vec3 first = vec3(((b_5 * c) * -0.008333334), ((a_9 * c) * 0.041666668), ((a_9 * b_5) * -0.083333336));
    vec3 last_1 = vec3(((e * f) * 0.083333336), ((d_1 * f) * -0.041666668), ((d_1 * e) * 0.008333334));
    return StudentTImplSix(uint(start), (((d_1 * e) * f) * first), (((a_9 * b_5) * c) * last_1));
}

vec3 student_t_impl_node(uint at_2) {
    vec2 _e1 = student_t_impl_pair(at_2);
    vec2 _e4 = student_t_impl_pair((at_2 + 1u));
    return vec3(_e1, _e4.x);
}

vec3 student_t_impl_row(uint at_3, StudentTImplSix six, vec3 less) {
    vec3 _e3 = student_t_impl_node(at_3);
    vec3 _e10 = student_t_impl_node((at_3 + 2u));
    vec3 _e18 = student_t_impl_node((at_3 + 4u));
    vec3 _e26 = student_t_impl_node((at_3 + 6u));
    vec3 _e33 = student_t_impl_node((at_3 + 8u));
    vec3 _e41 = student_t_impl_node((at_3 + 10u));
    return (((((_e3 - less) * six.a.x) + ((_e10 - less) * six.a.y)) + ((_e18 - less) * six.a.z)) + ((((_e26 - less) * six.b.x) + ((_e33 - less) * six.b.y)) + ((_e41 - less) * six.b.z)));
}

StudentTImplAlbedo student_t_impl_albedo_of(uint shape_16, vec2 sigma_15, uint masking_3) {
    bool local_6 = false;
    bool local_7 = false;
    StudentTAlbedoTable _e3 = student_t_impl_albedo_table(shape_16, masking_3);
    float _e5 = student_t_impl_sigma(sigma_15.x);
    float _e7 = student_t_impl_sigma(sigma_15.y);
    float product = (_e5 * _e7);
    float _e11 = student_t_impl_max(sqrt(product), _e3.sigma_min);
    float _e13 = student_t_impl_min(_e11, _e3.sigma_max);
    float lowest = ((_e3.floor_ * (_e3.slope * _e13)) / (_e3.floor_ + (_e3.slope * _e13)));
    float _e25 = student_t_impl_log_growth((_e13 / _e3.offset));
    float coordinate = ((_e25 + (_e3.slow * log((_e13 / _e3.first)))) + (_e3.linear * _e13));
    if (!((_e3.values == shape_16))) {
        if ((sigma_15.x > 0.0)) {
            local_7 = (sigma_15.y > 0.0);
        } else {
            local_7 = false;
        }
        bool _e49 = local_7;
        local_6 = !(_e49);
    } else {
        local_6 = true;
    }
    bool mirror = local_6;
    return StudentTImplAlbedo(_e3, (mirror ? 0.0 : _e13), ((coordinate - _e3.start) / _e3.range), lowest);
}

float student_t_impl_view(StudentTImplAlbedo a_5, float mu) {
    float sine = sqrt(max(((1.0 - mu) * (1.0 + mu)), 0.0));
    float x_9 = (mu / (mu + ((a_5.table.kappa * a_5.sigma) * sine)));
    float h = (mu / (1.0 + sine));
    float nu = (a_5.table.spread * a_5.sigma);
    float roots = ((a_5.table.share * sqrt(sqrt(x_9))) + ((1.0 - a_5.table.share) * sqrt(sqrt(h))));
    return (((a_5.table.weight * x_9) + (a_5.table.normal * (nu / (nu + sine)))) + (((1.0 - a_5.table.weight) - a_5.table.normal) * roots));
}

vec3 student_t_impl_mirror(float mu_1) {
    float k = (1.0 - mu_1);
    float fourth = ((k * k) * (k * k));
    return vec3(0.0, (fourth * k), ((17.651384 * mu_1) * (fourth * (k * k))));
}

vec3 student_t_impl_moments_at(StudentTImplAlbedo a_6, float mu_2) {
    float _e3 = student_t_impl_view(a_6, a_6.lowest);
    float _e4 = student_t_impl_view(a_6, mu_2);
    float at_6 = ((_e4 - _e3) / (1.0 - _e3));
    StudentTImplSix _e17 = student_t_impl_six((a_6.coordinate * (a_6.table.sigmas - 1.0)), a_6.table.sigmas);
    StudentTImplSix _e25 = student_t_impl_six((at_6 * (a_6.table.views - 1.0)), a_6.table.views);
    uint row = (2u * uint(a_6.table.views));
    uint first_1 = ((a_6.table.values + (_e17.start * row)) + (2u * _e25.start));
    vec3 _e45 = student_t_impl_node(((first_1 + (2u * row)) + 4u));
    vec3 _e46 = student_t_impl_row(first_1, _e25, _e45);
    vec3 _e51 = student_t_impl_row((first_1 + row), _e25, _e45);
    vec3 _e59 = student_t_impl_row((first_1 + (2u * row)), _e25, _e45);
    vec3 _e67 = student_t_impl_row((first_1 + (3u * row)), _e25, _e45);
    vec3 _e74 = student_t_impl_row((first_1 + (4u * row)), _e25, _e45);
    vec3 _e82 = student_t_impl_row((first_1 + (5u * row)), _e25, _e45);
    vec3 sum_1 = ((((_e46 * _e17.a.x) + (_e51 * _e17.a.y)) + (_e59 * _e17.a.z)) + (((_e67 * _e17.b.x) + (_e74 * _e17.b.y)) + (_e82 * _e17.b.z)));
    vec3 moments_1 = (_e45 + sum_1);
    float _e91 = student_t_impl_max(moments_1.x, -1.0);
    float _e93 = student_t_impl_min(_e91, 0.0);
    vec3 _e98 = student_t_impl_mirror(mu_2);
    return (vec3(_e93, moments_1.yz) + ((1.0 + _e93) * _e98));
}

vec3 student_t_impl_moments(StudentTImplAlbedo a_7, float cos_theta, uint masking_4) {
    float power = 1.0;
    float more = 0.0;
    float nearer = 1.0;
    float _e3 = student_t_impl_unit(cos_theta);
    if (!((a_7.sigma > 0.0))) {
        vec3 _e8 = student_t_impl_mirror(_e3);
        return _e8;
    }
    vec3 _e11 = student_t_impl_moments_at(a_7, max(_e3, a_7.lowest));
    if (!((_e3 < a_7.lowest))) {
        return _e11;
    }
    if (!((_e11.x < 0.0))) {
        vec3 _e19 = student_t_impl_mirror(_e3);
        return _e19;
    }
    vec3 _e23 = student_t_impl_moments_at(a_7, (4.0 * a_7.lowest));
    if ((masking_4 != STUDENT_T_UNCORRELATED)) {
        float ratio = (_e23.x / _e11.x);
        power = 0.0;
        if ((ratio > 1.0)) {
            float _e34 = student_t_impl_log(ratio);
            power = min((0.7213475 * _e34), 1.0);
        }
    }
    float _e41 = power;
    if ((_e41 > 0.0)) {
        if ((_e3 > 0.0)) {
            float _e48 = power;
            float _e53 = student_t_impl_exp_growth((_e48 * log((_e3 / a_7.lowest))));
            nearer = -(_e53);
        }
        float _e55 = nearer;
        float _e56 = power;
        float _e59 = student_t_impl_exp_growth((_e56 * 1.3862944));
        more = (_e55 / _e59);
    }
    float _e61 = more;
    vec3 limit = (_e11 + (_e61 * (_e11 - _e23)));
    float _e67 = student_t_impl_max(limit.x, -1.0);
    float _e69 = student_t_impl_min(_e67, 0.0);
    return vec3(_e69, limit.yz);
}

vec3 student_t_impl_averages(StudentTImplAlbedo a_8) {
    if (!((a_8.sigma > 0.0))) {
        return vec3(0.0, 0.04761905, 0.14009036);
    }
    float count = a_8.table.average_sigmas;
    StudentTImplSix _e15 = student_t_impl_six((a_8.coordinate * (count - 1.0)), count);
    vec3 _e24 = student_t_impl_row((a_8.table.averages + (2u * _e15.start)), _e15, vec3(0.0));
    return vec3(min(exp(_e24.x), 1.0), _e24.yz);
}

vec3 student_t_impl_limit(vec3 moments) {
    float _e3 = student_t_impl_max(moments.y, 0.0);
    float _e5 = student_t_impl_min(_e3, moments.x);
    float _e9 = student_t_impl_unit(moments.z);
    return vec3((moments.x - _e5), _e5, _e9);
}

float student_t_albedo(uint shape_17, vec2 sigma_16, float cos_theta_1, uint masking_5) {
    StudentTImplAlbedo _e4 = student_t_impl_albedo_of(shape_17, sigma_16, masking_5);
    vec3 _e5 = student_t_impl_moments(_e4, cos_theta_1, masking_5);
    return (1.0 + _e5.x);
}

vec3 student_t_albedo_parts(uint shape_18, vec2 sigma_17, float cos_theta_2, uint masking_6) {
    StudentTImplAlbedo _e4 = student_t_impl_albedo_of(shape_18, sigma_17, masking_6);
    vec3 _e5 = student_t_impl_moments(_e4, cos_theta_2, masking_6);
    vec3 _e11 = student_t_impl_limit(vec3((1.0 + _e5.x), _e5.yz));
    return _e11;
}

float student_t_albedo_average(uint shape_19, vec2 sigma_18, uint masking_7) {
    StudentTImplAlbedo _e3 = student_t_impl_albedo_of(shape_19, sigma_18, masking_7);
    vec3 _e4 = student_t_impl_averages(_e3);
    return (1.0 - _e4.x);
}

vec3 student_t_albedo_average_parts(uint shape_20, vec2 sigma_19, uint masking_8) {
    StudentTImplAlbedo _e3 = student_t_impl_albedo_of(shape_20, sigma_19, masking_8);
    vec3 _e4 = student_t_impl_averages(_e3);
    vec3 _e10 = student_t_impl_limit(vec3((1.0 - _e4.x), _e4.yz));
    return _e10;
}

float student_t_compensation(uint shape_21, vec2 sigma_20, vec3 v_9, vec3 l_2, uint masking_9) {
    bool local_8 = false;
    if ((v_9.z > 0.0)) {
        local_8 = (l_2.z > 0.0);
    } else {
        local_8 = false;
    }
    bool _e14 = local_8;
    if (!(_e14)) {
        return 0.0;
    }
    StudentTImplAlbedo _e17 = student_t_impl_albedo_of(shape_21, sigma_20, masking_9);
    vec3 _e18 = student_t_impl_averages(_e17);
    float lost = _e18.x;
    if (!((lost > 1.1754944e-38))) {
        return 0.0;
    }
    vec3 _e25 = student_t_impl_moments(_e17, v_9.z, masking_9);
    float of_view = _e25.x;
    vec3 _e28 = student_t_impl_moments(_e17, l_2.z, masking_9);
    float of_light = _e28.x;
    return (((0.31830987 * of_view) * of_light) / lost);
}

#endif
