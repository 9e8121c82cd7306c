#ifndef STUDENT_T
#define STUDENT_T

#ifndef STUDENT_T_REGISTER
#define STUDENT_T_REGISTER t0
#endif

struct StudentTLobe {
    float2 sigma;
    bool is_mirror;
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
    float linear_;
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
    float2 xy;
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

struct StudentTImplAlbedo {
    StudentTAlbedoTable table;
    float sigma;
    float coordinate;
    float lowest;
};

struct StudentTImplSix {
    uint start;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float3 a;
    int _pad2_0;
    float3 b;
    int _end_pad_0;
};

static const uint STUDENT_T_UNCORRELATED = 0u;
static const uint STUDENT_T_HEIGHT_CORRELATED = 1u;

Texture2D<float4> student_t_tables : register(STUDENT_T_REGISTER);

float2 student_t_impl_pair(uint at)
{
    float4 _e10 = student_t_tables.Load(int3(int2(int((at & 511u)), int((at >> 9u))), int(0)));
    return _e10.xy;
}

float student_t_impl_min(float a, float b)
{
    return ((a < b) ? a : b);
}

float student_t_impl_max(float a_1, float b_1)
{
    return ((a_1 > b_1) ? a_1 : b_1);
}

float student_t_impl_sigma(float sigma)
{
    const float _e2 = student_t_impl_max(sigma, 1e-8);
    const float _e4 = student_t_impl_min(_e2, 1000000.0);
    return _e4;
}

StudentTLobe ConstructStudentTLobe(float2 arg0, bool arg1, uint arg2, float arg3, float arg4, float arg5, float arg6, float arg7, float arg8, float arg9, uint arg10, float arg11, float arg12, float arg13, float arg14, float arg15, float arg16, float arg17, uint arg18, float arg19, uint arg20, float arg21, uint arg22, float arg23, float arg24) {
    StudentTLobe ret = (StudentTLobe)0;
    ret.sigma = arg0;
    ret.is_mirror = arg1;
    ret.shape = arg2;
    ret.is_ggx = arg3;
    ret.s = arg4;
    ret.d_s = arg5;
    ret.d_power = arg6;
    ret.kappa = arg7;
    ret.masking_crowded = arg8;
    ret.masking_cells = arg9;
    ret.masking = arg10;
    ret.rows = arg11;
    ret.rows_first = arg12;
    ret.rows_second = arg13;
    ret.rows_second_end = arg14;
    ret.rows_third = arg15;
    ret.numbers = arg16;
    ret.along_scale = arg17;
    ret.slopes = arg18;
    ret.across_scale = arg19;
    ret.across = arg20;
    ret.heavy_per_row = arg21;
    ret.heavy = arg22;
    ret.heavy_exponent = arg23;
    ret.heavy_root_s = arg24;
    return ret;
}

uint student_t_impl_f2u32(float value) {
    return uint(clamp(value, 0.0, 4294967000.0));
}

StudentTLobe student_t_lobe_of(uint shape, float2 sigma_1)
{
    bool local = (bool)0;

    const float2 _e4 = student_t_impl_pair((shape + 0u));
    const float2 _e7 = student_t_impl_pair((shape + 1u));
    const float2 _e10 = student_t_impl_pair((shape + 2u));
    const float2 _e13 = student_t_impl_pair((shape + 3u));
    const float2 _e16 = student_t_impl_pair((shape + 4u));
    const float2 _e19 = student_t_impl_pair((shape + 5u));
    const float2 _e22 = student_t_impl_pair((shape + 6u));
    const float2 _e25 = student_t_impl_pair((shape + 7u));
    const float2 _e28 = student_t_impl_pair((shape + 8u));
    const float2 _e31 = student_t_impl_pair((shape + 9u));
    const float2 _e34 = student_t_impl_pair((shape + 10u));
    const float _e36 = student_t_impl_sigma(sigma_1.x);
    const float _e38 = student_t_impl_sigma(sigma_1.y);
    if ((sigma_1.x > 0.0)) {
        local = (sigma_1.y > 0.0);
    } else {
        local = false;
    }
    bool _e49 = local;
    const StudentTLobe studenttlobe = ConstructStudentTLobe(float2(_e36, _e38), !(_e49), shape, _e4.x, _e4.y, _e7.x, _e7.y, _e10.x, _e10.y, _e13.x, (shape + student_t_impl_f2u32(_e13.y)), _e16.x, _e16.y, _e19.x, _e19.y, _e22.x, _e22.y, _e25.x, (shape + student_t_impl_f2u32(_e25.y)), _e28.x, (shape + student_t_impl_f2u32(_e28.y)), _e31.x, (shape + student_t_impl_f2u32(_e31.y)), _e34.x, _e34.y);
    return studenttlobe;
}

StudentTAlbedoTable ConstructStudentTAlbedoTable(uint arg0, uint arg1, float arg2, float arg3, float arg4, float arg5, float arg6, float arg7, float arg8, float arg9, float arg10, float arg11, float arg12, float arg13, float arg14, float arg15, float arg16, float arg17, float arg18, float arg19) {
    StudentTAlbedoTable ret = (StudentTAlbedoTable)0;
    ret.values = arg0;
    ret.averages = arg1;
    ret.sigmas = arg2;
    ret.average_sigmas = arg3;
    ret.views = arg4;
    ret.offset = arg5;
    ret.first = arg6;
    ret.slow = arg7;
    ret.linear_ = arg8;
    ret.start = arg9;
    ret.range = arg10;
    ret.sigma_min = arg11;
    ret.sigma_max = arg12;
    ret.weight = arg13;
    ret.normal = arg14;
    ret.share = arg15;
    ret.kappa = arg16;
    ret.spread = arg17;
    ret.floor_ = arg18;
    ret.slope = arg19;
    return ret;
}

StudentTAlbedoTable student_t_impl_albedo_table(uint shape_1, uint masking)
{
    uint at_5 = (shape_1 + ((masking == STUDENT_T_UNCORRELATED) ? 11u : 21u));
    const float2 _e10 = student_t_impl_pair((at_5 + 0u));
    const float2 _e13 = student_t_impl_pair((at_5 + 1u));
    const float2 _e16 = student_t_impl_pair((at_5 + 2u));
    const float2 _e19 = student_t_impl_pair((at_5 + 3u));
    const float2 _e22 = student_t_impl_pair((at_5 + 4u));
    const float2 _e25 = student_t_impl_pair((at_5 + 5u));
    const float2 _e28 = student_t_impl_pair((at_5 + 6u));
    const float2 _e31 = student_t_impl_pair((at_5 + 7u));
    const float2 _e34 = student_t_impl_pair((at_5 + 8u));
    const float2 _e37 = student_t_impl_pair((at_5 + 9u));
    const StudentTAlbedoTable studenttalbedotable = ConstructStudentTAlbedoTable((shape_1 + student_t_impl_f2u32(_e10.x)), (shape_1 + student_t_impl_f2u32(_e10.y)), _e13.x, _e13.y, _e16.x, _e16.y, _e19.x, _e19.y, _e22.x, _e22.y, _e25.x, _e25.y, _e28.x, _e28.y, _e31.x, _e31.y, _e34.x, _e34.y, _e37.x, _e37.y);
    return studenttalbedotable;
}

float student_t_impl_unit(float x)
{
    const float _e2 = student_t_impl_max(x, 0.0);
    const float _e4 = student_t_impl_min(_e2, 1.0);
    return _e4;
}

float student_t_impl_product(float a_2, float b_2)
{
    bool local_1 = (bool)0;

    if ((b_2 > 1.0)) {
        local_1 = (a_2 > (3.402823e38 / b_2));
    } else {
        local_1 = false;
    }
    bool _e10 = local_1;
    if (_e10) {
        return 3.402823e38;
    }
    return (a_2 * b_2);
}

float student_t_impl_log_growth(float x_1)
{
    bool local_2 = (bool)0;

    if ((x_1 >= -0.5)) {
        local_2 = (x_1 <= 1.0);
    } else {
        local_2 = false;
    }
    bool _e8 = local_2;
    if (!(_e8)) {
        return log((1.0 + x_1));
    }
    float y = (x_1 / (2.0 + x_1));
    float q = (y * y);
    float tail = (q * (0.11111111 + (q * (0.09090909 + (q * (0.07692308 + (q * 0.06666667)))))));
    return ((2.0 * y) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + tail))))))));
}

float student_t_impl_log(float x_2)
{
    bool local_3 = (bool)0;

    if ((x_2 >= 0.5)) {
        local_3 = (x_2 <= 2.0);
    } else {
        local_3 = false;
    }
    bool _e8 = local_3;
    if (_e8) {
        const float _e11 = student_t_impl_log_growth((x_2 - 1.0));
        return _e11;
    }
    return log(x_2);
}

float student_t_impl_exp_growth(float x_3)
{
    if ((abs(x_3) > 0.5)) {
        return (exp(x_3) - 1.0);
    }
    float tail_1 = (0.008333334 + (x_3 * (0.0013888889 + (x_3 * (0.0001984127 + (x_3 * 2.4801588e-5))))));
    return (x_3 * (1.0 + (x_3 * (0.5 + (x_3 * (0.16666667 + (x_3 * (0.041666668 + (x_3 * tail_1)))))))));
}

StudentTImplPlace ConstructStudentTImplPlace(uint arg0, float arg1) {
    StudentTImplPlace ret = (StudentTImplPlace)0;
    ret.cell = arg0;
    ret.position = arg1;
    return ret;
}

StudentTImplPlace student_t_impl_place(float x_4, float last)
{
    uint cell = min(student_t_impl_f2u32(x_4), student_t_impl_f2u32(last));
    const StudentTImplPlace studenttimplplace = ConstructStudentTImplPlace(cell, (x_4 - float(cell)));
    return studenttimplplace;
}

float student_t_impl_hermite(float2 a_3, float2 b_3, float w)
{
    float value_a = (1.0 + (w * (w * ((w * 2.0) - 3.0))));
    float slope_a = (w * (1.0 + (w * (w - 2.0))));
    float value_b = (w * (w * (3.0 - (w * 2.0))));
    float slope_b = (w * (w * (w - 1.0)));
    return (((a_3.x * value_a) + (b_3.x * value_b)) + ((a_3.y * slope_a) + (b_3.y * slope_b)));
}

StudentTImplDirection ConstructStudentTImplDirection(float2 arg0, float arg1, float arg2, float arg3, float arg4) {
    StudentTImplDirection ret = (StudentTImplDirection)0;
    ret.xy = arg0;
    ret.frame = arg1;
    ret.rho = arg2;
    ret.z = arg3;
    ret.square = arg4;
    return ret;
}

StudentTImplDirection student_t_impl_stretch(float2 sigma_2, float3 w_1)
{
    const float _e3 = student_t_impl_unit(w_1.z);
    float2 xy = (sigma_2 * w_1.xy);
    float square = ((xy.x * xy.x) + (xy.y * xy.y));
    float rho = sqrt(square);
    if ((rho >= 1e-6)) {
        const StudentTImplDirection studenttimpldirection = ConstructStudentTImplDirection(xy, rho, rho, _e3, square);
        return studenttimpldirection;
    } else {
        if ((rho >= 1e-18)) {
            const StudentTImplDirection studenttimpldirection_1 = ConstructStudentTImplDirection((xy / (rho).xx), 1.0, rho, _e3, square);
            return studenttimpldirection_1;
        }
    }
    float up = ((_e3 > 0.0) ? 1.0 : 0.0);
    const StudentTImplDirection studenttimpldirection_2 = ConstructStudentTImplDirection(float2(1.0, 0.0), 1.0, (1.0 - up), up, (1.0 - up));
    return studenttimpldirection_2;
}

float student_t_impl_cubic(uint table, StudentTImplPlace place)
{
    const float2 _e6 = student_t_impl_pair((table + (2u * place.cell)));
    const float2 _e13 = student_t_impl_pair(((table + (2u * place.cell)) + 1u));
    float w_7 = place.position;
    return ((_e6.x + (w_7 * _e6.y)) + ((w_7 * w_7) * (_e13.x + (w_7 * _e13.y))));
}

float student_t_impl_masking_at(StudentTLobe lobe, StudentTImplPlace place_1)
{
    const float _e3 = student_t_impl_cubic(lobe.masking, place_1);
    return _e3;
}

float student_t_impl_inverse_area(StudentTLobe lobe_1, StudentTImplDirection d)
{
    float at_1 = (float)0;

    if ((lobe_1.is_ggx > 0.0)) {
        float tall_1 = (d.z + sqrt((d.square + (d.z * d.z))));
        const float _e14 = student_t_impl_max(tall_1, 1.1754944e-38);
        return (2.0 / _e14);
    }
    float across = (lobe_1.kappa * d.rho);
    const float _e23 = student_t_impl_max((d.z + across), 1e-30);
    float r = (lobe_1.masking_cells / _e23);
    at_1 = (d.z * r);
    if ((lobe_1.masking_crowded > 0.0)) {
        const float _e33 = student_t_impl_unit((across / _e23));
        at_1 = ((1.0 - sqrt(_e33)) * lobe_1.masking_cells);
    }
    float _e39 = at_1;
    const StudentTImplPlace _e41 = student_t_impl_place(_e39, lobe_1.masking_cells);
    const float _e42 = student_t_impl_masking_at(lobe_1, _e41);
    return (_e42 * r);
}

float student_t_impl_dot(float3 a_4, float3 b_4)
{
    return (((a_4.x * b_4.x) + (a_4.y * b_4.y)) + (a_4.z * b_4.z));
}

float3 student_t_impl_raise(float3 m, float shrink)
{
    float r_1 = (1.0 / sqrt((((m.x * m.x) + (m.z * m.z)) + (m.y * m.y))));
    const float _e24 = student_t_impl_max(((m.z * r_1) * shrink), 1e-18);
    return float3((m.x * r_1), (m.y * r_1), _e24);
}

float3 student_t_impl_face(float3 v, float3 m_1)
{
    const float _e2 = student_t_impl_dot(v, m_1);
    if ((_e2 < 0.0)) {
        const float _e5 = student_t_impl_dot(v, v);
        const float _e7 = student_t_impl_max(_e5, 1.1754944e-38);
        const float3 _e12 = student_t_impl_raise((m_1 - ((_e2 / _e7) * v)), 1.0);
        return _e12;
    }
    return m_1;
}

float student_t_impl_d(StudentTLobe lobe_2, float3 m_2, float length_square)
{
    bool local_4 = (bool)0;
    float root = (float)0;
    float growth = (float)0;

    float2 slope_1 = (m_2.xy / lobe_2.sigma);
    float square_1 = (m_2.z * m_2.z);
    float part = (lobe_2.d_s * ((slope_1.x * slope_1.x) + (slope_1.y * slope_1.y)));
    if ((m_2.z > 0.0)) {
        local_4 = (part >= 0.0);
    } else {
        local_4 = false;
    }
    bool _e26 = local_4;
    if (!(_e26)) {
        return 0.0;
    }
    const float _e31 = student_t_impl_max((square_1 + part), 1.1754944e-38);
    root = (length_square / _e31);
    if (!((lobe_2.is_ggx > 0.0))) {
        growth = (log(_e31) - (2.0 * log(m_2.z)));
        if ((part < (1000.0 * square_1))) {
            const float _e49 = student_t_impl_log_growth((part / square_1));
            growth = _e49;
        }
        float _e50 = root;
        float _e52 = growth;
        root = (_e50 * exp((lobe_2.d_power * _e52)));
    }
    float scale = sqrt((1.0 / ((3.1415927 * lobe_2.sigma.x) * lobe_2.sigma.y)));
    float _e66 = root;
    float limited = min((scale * min(_e66, 1e30)), 1.8446742e19);
    return (limited * limited);
}

float student_t_lobe_d(StudentTLobe lobe_3, float3 m_3)
{
    const float _e3 = student_t_impl_d(lobe_3, m_3, 1.0);
    return _e3;
}

float student_t_lobe_masking(StudentTLobe lobe_4, float3 w_2)
{
    const StudentTImplDirection _e3 = student_t_impl_stretch(lobe_4.sigma, w_2);
    const float _e5 = student_t_impl_inverse_area(lobe_4, _e3);
    const float _e8 = student_t_impl_min((_e3.z * _e5), 1.0);
    return _e8;
}

float student_t_lobe_lambda(StudentTLobe lobe_5, float3 w_3)
{
    const float _e2 = student_t_lobe_masking(lobe_5, w_3);
    const float _e4 = student_t_impl_max(_e2, 1.1754944e-38);
    return ((1.0 / _e4) - 1.0);
}

float student_t_lobe_masking_shadowing(StudentTLobe lobe_6, float3 v_1, float3 l, uint masking_1)
{
    bool local_5 = (bool)0;

    const float _e4 = student_t_lobe_masking(lobe_6, v_1);
    const float _e5 = student_t_lobe_masking(lobe_6, l);
    float both = (_e4 * _e5);
    float sum = ((_e4 + _e5) - both);
    if (!((masking_1 == STUDENT_T_UNCORRELATED))) {
        local_5 = !((sum > 0.0));
    } else {
        local_5 = true;
    }
    bool _e18 = local_5;
    if (_e18) {
        return both;
    }
    return (both / sum);
}

float student_t_impl_weight(float a_5, float b_5, uint masking_2)
{
    if (!((b_5 > 0.0))) {
        return 0.0;
    }
    if ((masking_2 == STUDENT_T_UNCORRELATED)) {
        return b_5;
    }
    return (b_5 / (b_5 + (a_5 * (1.0 - b_5))));
}

float student_t_lobe_reflection_weight(StudentTLobe lobe_7, float3 v_2, float3 l_1, uint masking_3)
{
    if (!((v_2.z > 0.0))) {
        return 0.0;
    }
    const float _e9 = student_t_lobe_masking(lobe_7, v_2);
    const float _e10 = student_t_lobe_masking(lobe_7, l_1);
    const float _e11 = student_t_impl_weight(_e9, _e10, masking_3);
    return _e11;
}

float2 student_t_lobe_eval_pdf(StudentTLobe lobe_8, float3 v_3, float3 l_2, uint masking_4)
{
    bool local_6 = (bool)0;

    if ((v_3.z > 0.0)) {
        local_6 = (l_2.z > 0.0);
    } else {
        local_6 = false;
    }
    bool _e13 = local_6;
    if (!(_e13)) {
        return (0.0).xx;
    }
    float3 both_1 = (v_3 + l_2);
    float3 m_10 = float3(both_1.xy, max(both_1.z, 7.666467e-20));
    const StudentTImplDirection _e24 = student_t_impl_stretch(lobe_8.sigma, v_3);
    const float _e25 = student_t_impl_inverse_area(lobe_8, _e24);
    const float _e29 = student_t_impl_min((_e24.z * _e25), 1.0);
    const float _e30 = student_t_lobe_masking(lobe_8, l_2);
    const float _e31 = student_t_impl_weight(_e29, _e30, masking_4);
    const float _e32 = student_t_impl_dot(m_10, m_10);
    const float _e33 = student_t_impl_d(lobe_8, m_10, _e32);
    float density = (0.25 * _e33);
    const float _e36 = student_t_impl_product(density, _e25);
    const float _e43 = student_t_impl_product((_e31 * _e36), (1.0 / max(l_2.z, 1e-37)));
    return float2(_e43, _e36);
}

bool student_t_effectively_smooth(StudentTLobe lobe_9)
{
    bool local_7 = (bool)0;

    float sigma_20 = max(lobe_9.sigma.x, lobe_9.sigma.y);
    if (!(((0.56 * sigma_20) < 0.001))) {
        return false;
    }
    StudentTImplDirection level = ConstructStudentTImplDirection((0.0).xx, 1.0, 1.0, 0.0, 1.0);
    const float _e19 = student_t_impl_inverse_area(lobe_9, level);
    float mean = (2.0 / _e19);
    float rho_1 = (0.99995 * sigma_20);
    StudentTImplDirection grazing = ConstructStudentTImplDirection((0.0).xx, 1.0, rho_1, 0.01, (rho_1 * rho_1));
    if (((sigma_20 * mean) < 0.001)) {
        const float _e35 = student_t_impl_inverse_area(lobe_9, grazing);
        local_7 = ((1.0 - (0.01 * _e35)) <= 0.0025);
    } else {
        local_7 = false;
    }
    bool _e43 = local_7;
    return _e43;
}

float student_t_impl_sine(float x_5)
{
    float y_1 = (x_5 * x_5);
    float tail_2 = (y_1 * (81.60248 + (y_1 * (-76.58117 + (y_1 * 39.759827)))));
    return (x_5 * (6.2831855 + (y_1 * (-41.34168 + tail_2))));
}

float2 student_t_impl_turn(float u)
{
    float x_7 = (0.5 - u);
    float quarter = (abs(x_7) - 0.25);
    float rest_1 = (0.25 - abs(quarter));
    const float _e9 = student_t_impl_sine(quarter);
    const float _e14 = student_t_impl_sine(((x_7 < 0.0) ? -(rest_1) : rest_1));
    return float2(_e9, _e14);
}

float3 student_t_impl_sample_cap(float2 sigma_3, float3 v_4, float2 u_1)
{
    float3 w_4 = (float3)0;
    float tall = (float)0;

    const float _e6 = student_t_impl_max(v_4.z, 0.0);
    float3 above = float3(v_4.xy, _e6);
    w_4 = float3((sigma_3 * above.xy), above.z);
    float3 _e13 = w_4;
    float3 _e14 = w_4;
    const float _e15 = student_t_impl_dot(_e13, _e14);
    tall = sqrt(_e15);
    float _e18 = tall;
    if (!((_e18 >= 1e-6))) {
        float3 _e26 = w_4;
        float _e27 = tall;
        float _e32 = tall;
        w_4 = ((_e32 > 0.0) ? (_e26 / (max(_e27, 1e-37)).xxx) : float3(0.0, 0.0, 1.0));
        tall = 1.0;
    }
    const float _e38 = student_t_impl_unit(u_1.x);
    float _e43 = tall;
    float _e45 = w_4.z;
    float height = (max((1.0 - _e38), 5.9604645e-8) * (_e43 + _e45));
    float _e49 = w_4.z;
    float up_1 = (height - _e49);
    float _e51 = tall;
    float _e53 = tall;
    float radius = sqrt(max(((_e51 - up_1) * (_e53 + up_1)), 0.0));
    float3 _e59 = w_4;
    const float _e62 = student_t_impl_unit(u_1.y);
    const float2 _e63 = student_t_impl_turn(_e62);
    float2 point_ = (_e59.xy + (radius * _e63));
    const float3 _e69 = student_t_impl_raise(float3((sigma_3 * point_), height), 1.0);
    const float3 _e70 = student_t_impl_face(above, _e69);
    return _e70;
}

float student_t_impl_end(float u_2)
{
    const float _e3 = student_t_impl_min(u_2, (1.0 - u_2));
    const float _e5 = student_t_impl_max(_e3, 0.0);
    return sqrt(sqrt(_e5));
}

StudentTImplHalfSlope ConstructStudentTImplHalfSlope(float arg0, float arg1, float arg2, float arg3, float arg4) {
    StudentTImplHalfSlope ret = (StudentTImplHalfSlope)0;
    ret.x = arg0;
    ret.z = arg1;
    ret.sign_ = arg2;
    ret.shrink = arg3;
    ret.clear = arg4;
    return ret;
}

StudentTImplHalfSlope student_t_impl_heavy_slope(StudentTLobe lobe_10, float number)
{
    const float _e4 = student_t_impl_log(max(number, 1e-37));
    float power_1 = max((_e4 * lobe_10.heavy_exponent), -69.3);
    float zeta = exp(power_1);
    float large = max(zeta, 1e-15);
    const float _e14 = student_t_impl_exp_growth((2.0 * power_1));
    float x_8 = (0.5 * sqrt(max(-(_e14), 0.0)));
    float z = (large * lobe_10.heavy_root_s);
    const StudentTImplHalfSlope studenttimplhalfslope = ConstructStudentTImplHalfSlope(x_8, z, 1.0, (zeta / large), (x_8 + z));
    return studenttimplhalfslope;
}

float student_t_impl_along_at(StudentTLobe lobe_11, StudentTImplPlace view, uint second, StudentTImplPlace number_1)
{
    float2 a_6 = (float2)0;
    float2 b_6 = (float2)0;

    uint numbers = student_t_impl_f2u32(lobe_11.numbers);
    uint low = ((lobe_11.slopes + (((2u * view.cell) + second) * numbers)) + number_1.cell);
    uint high = (low + (2u * numbers));
    const float2 _e18 = student_t_impl_pair(low);
    a_6 = _e18;
    const float2 _e22 = student_t_impl_pair((low + 1u));
    b_6 = _e22;
    float2 _e24 = a_6;
    const float2 _e26 = student_t_impl_pair(high);
    float2 _e27 = a_6;
    a_6 = (_e24 + (view.position * (_e26 - _e27)));
    float2 _e31 = b_6;
    const float2 _e35 = student_t_impl_pair((high + 1u));
    float2 _e36 = b_6;
    b_6 = (_e31 + (view.position * (_e35 - _e36)));
    float2 _e40 = a_6;
    float2 _e41 = b_6;
    const float _e43 = student_t_impl_hermite(_e40, _e41, number_1.position);
    return _e43;
}

StudentTImplHalfSlope student_t_impl_table_slope(StudentTLobe lobe_12, float along, float at_2, float silhouette)
{
    bool second_1 = (along > 0.5);
    const StudentTImplPlace _e7 = student_t_impl_place(at_2, lobe_12.rows);
    const float _e8 = student_t_impl_end(along);
    const StudentTImplPlace _e14 = student_t_impl_place((_e8 * lobe_12.along_scale), (lobe_12.numbers - 1.0));
    const float _e16 = student_t_impl_along_at(lobe_12, _e7, uint(second_1), _e14);
    float sign_ = (second_1 ? -1.0 : 1.0);
    float clear = (_e16 - (second_1 ? 0.0 : silhouette));
    const StudentTImplHalfSlope studenttimplhalfslope_1 = ConstructStudentTImplHalfSlope((_e16 - 1.0), (_e16 * (2.0 - _e16)), sign_, 1.0, clear);
    return studenttimplhalfslope_1;
}

float student_t_impl_across_at(StudentTLobe lobe_13, StudentTImplPlace place_2)
{
    const float _e3 = student_t_impl_cubic(lobe_13.across, place_2);
    return _e3;
}

float2 student_t_impl_share_at(StudentTLobe lobe_14, StudentTImplPlace place_3)
{
    const float _e3 = student_t_impl_cubic(lobe_14.heavy, place_3);
    return float2(_e3, (1.0 - _e3));
}

float3 student_t_impl_sample_tables(StudentTLobe lobe_15, float3 v_5, float2 u_3)
{
    float rest = (float)0;
    float along_1 = (float)0;
    bool is_heavy = false;
    float number_2 = 1.0;
    StudentTImplHalfSlope slope = (StudentTImplHalfSlope)0;

    const float _e4 = student_t_impl_end(u_3.y);
    const StudentTImplPlace _e12 = student_t_impl_place((_e4 * lobe_15.across_scale), ((0.8408964 * lobe_15.across_scale) + 0.5));
    const float _e13 = student_t_impl_across_at(lobe_15, _e12);
    float t = ((u_3.y > 0.5) ? (1.0 - _e13) : (_e13 - 1.0));
    float tz = (_e13 * (2.0 - _e13));
    const StudentTImplDirection _e26 = student_t_impl_stretch(lobe_15.sigma, v_5);
    float tall_2 = sqrt((_e26.square + (_e26.z * _e26.z)));
    rest = (1.0 - (_e26.z / (_e26.rho + tall_2)));
    if ((lobe_15.heavy_per_row > 0.0)) {
        float steep = (tall_2 + _e26.z);
        rest = ((_e26.rho * (steep + _e26.rho)) / (steep * (_e26.rho + tall_2)));
    }
    float _e53 = rest;
    const float _e54 = student_t_impl_unit(_e53);
    float at_6 = max(max((lobe_15.rows_first - (lobe_15.rows_first * _e54)), (lobe_15.rows_second_end - (lobe_15.rows_second * _e54))), (lobe_15.rows - (lobe_15.rows_third * _e54)));
    const float _e70 = student_t_impl_unit(u_3.x);
    along_1 = _e70;
    if ((lobe_15.heavy_per_row > 0.0)) {
        float cells = lobe_15.heavy_per_row;
        const StudentTImplPlace _e83 = student_t_impl_place((at_6 * cells), (lobe_15.rows * cells));
        const float2 _e84 = student_t_impl_share_at(lobe_15, _e83);
        float _e85 = along_1;
        is_heavy = (_e85 > _e84.y);
        bool _e88 = is_heavy;
        if (_e88) {
            float _e89 = along_1;
            number_2 = min(((1.0 - _e89) / _e84.x), 1.0);
        }
        float _e96 = along_1;
        along_1 = (_e96 / _e84.y);
    }
    bool _e100 = is_heavy;
    if (_e100) {
        float _e101 = number_2;
        const StudentTImplHalfSlope _e102 = student_t_impl_heavy_slope(lobe_15, _e101);
        slope = _e102;
    } else {
        float _e103 = along_1;
        const StudentTImplHalfSlope _e104 = student_t_impl_table_slope(lobe_15, _e103, at_6, _e54);
        slope = _e104;
    }
    float _e106 = slope.z;
    float _e108 = slope.z;
    float _e114 = slope.x;
    float _e116 = slope.x;
    float norm = sqrt(((_e106 * _e108) + ((4.0 * lobe_15.s) * (_e114 * _e116))));
    float _e122 = slope.x;
    float _e124 = slope.sign_;
    float ahead = (_e122 * (_e124 * tz));
    float aside = (norm * t);
    float2 turned = float2(((ahead * _e26.xy.x) - (aside * _e26.xy.y)), ((ahead * _e26.xy.y) + (aside * _e26.xy.x)));
    float _e146 = slope.z;
    float _e154 = slope.shrink;
    const float3 _e155 = student_t_impl_raise(float3((lobe_15.sigma * turned), (_e146 * (0.5 * (_e26.frame * tz)))), _e154);
    float _e157 = slope.clear;
    if (!(((_e157 * tz) >= ((1e-5 * tz) + (2e-5 * abs(t)))))) {
        const float3 _e170 = student_t_impl_face(float3(v_5.xy, _e26.z), _e155);
        return _e170;
    }
    return _e155;
}

float3 student_t_lobe_sample_visible_normal(StudentTLobe lobe_16, float3 v_6, float2 u_4)
{
    if ((lobe_16.is_ggx > 0.0)) {
        const float3 _e7 = student_t_impl_sample_cap(lobe_16.sigma, v_6, u_4);
        return _e7;
    }
    const float3 _e8 = student_t_impl_sample_tables(lobe_16, v_6, u_4);
    return _e8;
}

float student_t_lobe_visible_normal_pdf(StudentTLobe lobe_17, float3 v_7, float3 m_4)
{
    const float _e3 = student_t_impl_dot(v_7, m_4);
    const float _e5 = student_t_impl_max(_e3, 0.0);
    const float _e6 = student_t_lobe_d(lobe_17, m_4);
    float density_1 = (_e5 * _e6);
    const StudentTImplDirection _e9 = student_t_impl_stretch(lobe_17.sigma, v_7);
    const float _e10 = student_t_impl_inverse_area(lobe_17, _e9);
    const float _e11 = student_t_impl_product(density_1, _e10);
    return _e11;
}

float3 student_t_reflect(float3 v_8, float3 m_5)
{
    const float _e2 = student_t_impl_dot(v_8, m_5);
    return (((2.0 * _e2) * m_5) - v_8);
}

float student_t_lobe_reflection_pdf(StudentTLobe lobe_18, float3 v_9, float3 m_6)
{
    const float _e3 = student_t_impl_dot(v_9, m_6);
    if (!((_e3 > 0.0))) {
        return 0.0;
    }
    const float _e8 = student_t_lobe_d(lobe_18, m_6);
    float density_2 = (0.25 * _e8);
    const StudentTImplDirection _e12 = student_t_impl_stretch(lobe_18.sigma, v_9);
    const float _e13 = student_t_impl_inverse_area(lobe_18, _e12);
    const float _e14 = student_t_impl_product(density_2, _e13);
    return _e14;
}

float student_t_impl_tail(float gamma)
{
    const float _e2 = student_t_impl_max(gamma, 1.501);
    const float _e4 = student_t_impl_min(_e2, 1000000000000.0);
    return (1.0 / (_e4 - 1.0));
}

float student_t_impl_facing_pdf(float slope2_, float sigma_4, float s)
{
    float x_9 = ((slope2_ / sigma_4) / sigma_4);
    const float _e11 = student_t_impl_log_growth((s * x_9));
    float power_2 = exp((-((1.0 + (1.0 / s))) * _e11));
    float scale_1 = ((1.0 + slope2_) / sigma_4);
    const float _e18 = student_t_impl_product((power_2 * scale_1), scale_1);
    const float _e20 = student_t_impl_product(_e18, 0.07957747);
    return _e20;
}

float4 student_t_prefilter_light(float2 u_5, float sigma_5, float gamma_1)
{
    const float _e3 = student_t_impl_tail(gamma_1);
    const float _e4 = student_t_impl_sigma(sigma_5);
    const float _e6 = student_t_impl_unit(u_5.x);
    const float _e8 = student_t_impl_min(_e6, 0.99999994);
    const float _e11 = student_t_impl_log_growth(-(_e8));
    const float _e13 = student_t_impl_exp_growth((-(_e3) * _e11));
    float slope_2 = (_e4 * sqrt((_e13 / _e3)));
    float slope_2_ = (slope_2 * slope_2);
    float secant_2_ = (1.0 + slope_2_);
    float sine = ((2.0 * slope_2) / secant_2_);
    const float _e24 = student_t_impl_unit(u_5.y);
    const float2 _e25 = student_t_impl_turn(_e24);
    const float _e26 = student_t_impl_facing_pdf(slope_2_, _e4, _e3);
    return float4((sine * _e25), ((1.0 - slope_2_) / secant_2_), _e26);
}

float student_t_prefilter_pdf(float cos_theta, float sigma_6, float gamma_2)
{
    const float _e3 = student_t_impl_unit(cos_theta);
    if (!((cos_theta > 0.0))) {
        return 0.0;
    }
    const float _e8 = student_t_impl_tail(gamma_2);
    const float _e14 = student_t_impl_sigma(sigma_6);
    const float _e15 = student_t_impl_facing_pdf(((1.0 - _e3) / (1.0 + _e3)), _e14, _e8);
    return _e15;
}

float3 student_t_impl_mirror(float mu)
{
    float k = (1.0 - mu);
    float fourth = ((k * k) * (k * k));
    return float3(0.0, (fourth * k), ((17.651384 * mu) * (fourth * (k * k))));
}

float3 student_t_impl_mirror_average()
{
    return float3(0.0, 0.04761905, 0.14009036);
}

float3 student_t_impl_limit(float3 moments)
{
    const float _e3 = student_t_impl_max(moments.y, 0.0);
    const float _e5 = student_t_impl_min(_e3, moments.x);
    const float _e9 = student_t_impl_unit(moments.z);
    return float3((moments.x - _e5), _e5, _e9);
}

StudentTImplAlbedo ConstructStudentTImplAlbedo(StudentTAlbedoTable arg0, float arg1, float arg2, float arg3) {
    StudentTImplAlbedo ret = (StudentTImplAlbedo)0;
    ret.table = arg0;
    ret.sigma = arg1;
    ret.coordinate = arg2;
    ret.lowest = arg3;
    return ret;
}

StudentTImplAlbedo student_t_impl_albedo_of(StudentTLobe lobe_19, uint masking_5)
{
    bool local_8 = (bool)0;

    const StudentTAlbedoTable _e3 = student_t_impl_albedo_table(lobe_19.shape, masking_5);
    float stand_in = sqrt((lobe_19.sigma.x * lobe_19.sigma.y));
    const float _e11 = student_t_impl_max(stand_in, _e3.sigma_min);
    const float _e13 = student_t_impl_min(_e11, _e3.sigma_max);
    float lowest = ((_e3.floor_ * (_e3.slope * _e13)) / (_e3.floor_ + (_e3.slope * _e13)));
    const float _e25 = student_t_impl_log_growth((_e13 / _e3.offset));
    float coordinate = ((_e25 + (_e3.slow * log((_e13 / _e3.first)))) + (_e3.linear_ * _e13));
    if (!(lobe_19.is_mirror)) {
        local_8 = (_e3.values == lobe_19.shape);
    } else {
        local_8 = true;
    }
    bool mirror = local_8;
    const StudentTImplAlbedo studenttimplalbedo = ConstructStudentTImplAlbedo(_e3, (mirror ? 0.0 : _e13), ((coordinate - _e3.start) / _e3.range), lowest);
    return studenttimplalbedo;
}

float student_t_impl_view(StudentTImplAlbedo a_7, float mu_1)
{
    float sine_1 = sqrt(max(((1.0 - mu_1) * (1.0 + mu_1)), 0.0));
    float x_10 = (mu_1 / (mu_1 + ((a_7.table.kappa * a_7.sigma) * sine_1)));
    float h = (mu_1 / (1.0 + sine_1));
    float nu = (a_7.table.spread * a_7.sigma);
    float roots = ((a_7.table.share * sqrt(sqrt(x_10))) + ((1.0 - a_7.table.share) * sqrt(sqrt(h))));
    return (((a_7.table.weight * x_10) + (a_7.table.normal * (nu / (nu + sine_1)))) + (((1.0 - a_7.table.weight) - a_7.table.normal) * roots));
}

StudentTImplSix ConstructStudentTImplSix(uint arg0, float3 arg1, float3 arg2) {
    StudentTImplSix ret = (StudentTImplSix)0;
    ret.start = arg0;
    ret.a = arg1;
    ret.b = arg2;
    return ret;
}

StudentTImplSix student_t_impl_six(float x_6, float n)
{
    const float _e3 = student_t_impl_max(x_6, 0.0);
    const float _e6 = student_t_impl_min(_e3, (n - 1.0));
    float start = max(min((floor(_e6) - 2.0), (n - 6.0)), 0.0);
    float a_12 = (_e6 - start);
    float b_7 = (a_12 - 1.0);
    float c = (a_12 - 2.0);
    float d_1 = (a_12 - 3.0);
    float e = (a_12 - 4.0);
    float f = (a_12 - 5.0);
    float3 first = float3(((b_7 * c) * -0.008333334), ((a_12 * c) * 0.041666668), ((a_12 * b_7) * -0.083333336));
    float3 last_1 = float3(((e * f) * 0.083333336), ((d_1 * f) * -0.041666668), ((d_1 * e) * 0.008333334));
    const StudentTImplSix studenttimplsix = ConstructStudentTImplSix(student_t_impl_f2u32(start), (((d_1 * e) * f) * first), (((a_12 * b_7) * c) * last_1));
    return studenttimplsix;
}

float3 student_t_impl_node(uint at_3)
{
    const float2 _e1 = student_t_impl_pair(at_3);
    const float2 _e4 = student_t_impl_pair((at_3 + 1u));
    return float3(_e1, _e4.x);
}

float3 student_t_impl_row(uint at_4, StudentTImplSix six, float3 less)
{
    const float3 _e3 = student_t_impl_node(at_4);
    const float3 _e10 = student_t_impl_node((at_4 + 2u));
    const float3 _e18 = student_t_impl_node((at_4 + 4u));
    const float3 _e26 = student_t_impl_node((at_4 + 6u));
    const float3 _e33 = student_t_impl_node((at_4 + 8u));
    const float3 _e41 = student_t_impl_node((at_4 + 10u));
    return (((((_e3 - less) * six.a.x) + ((_e10 - less) * six.a.y)) + ((_e18 - less) * six.a.z)) + ((((_e26 - less) * six.b.x) + ((_e33 - less) * six.b.y)) + ((_e41 - less) * six.b.z)));
}

float3 student_t_impl_moments_at(StudentTImplAlbedo a_8, float mu_2)
{
    const float _e3 = student_t_impl_view(a_8, a_8.lowest);
    const float _e4 = student_t_impl_view(a_8, mu_2);
    float at_7 = ((_e4 - _e3) / (1.0 - _e3));
    const StudentTImplSix _e17 = student_t_impl_six((a_8.coordinate * (a_8.table.sigmas - 1.0)), a_8.table.sigmas);
    const StudentTImplSix _e25 = student_t_impl_six((at_7 * (a_8.table.views - 1.0)), a_8.table.views);
    uint row = (2u * student_t_impl_f2u32(a_8.table.views));
    uint first_1 = ((a_8.table.values + (_e17.start * row)) + (2u * _e25.start));
    const float3 _e45 = student_t_impl_node(((first_1 + (2u * row)) + 4u));
    const float3 _e46 = student_t_impl_row(first_1, _e25, _e45);
    const float3 _e51 = student_t_impl_row((first_1 + row), _e25, _e45);
    const float3 _e59 = student_t_impl_row((first_1 + (2u * row)), _e25, _e45);
    const float3 _e67 = student_t_impl_row((first_1 + (3u * row)), _e25, _e45);
    const float3 _e74 = student_t_impl_row((first_1 + (4u * row)), _e25, _e45);
    const float3 _e82 = student_t_impl_row((first_1 + (5u * row)), _e25, _e45);
    float3 sum_1 = ((((_e46 * _e17.a.x) + (_e51 * _e17.a.y)) + (_e59 * _e17.a.z)) + (((_e67 * _e17.b.x) + (_e74 * _e17.b.y)) + (_e82 * _e17.b.z)));
    float3 moments_1 = (_e45 + sum_1);
    const float _e91 = student_t_impl_max(moments_1.x, -1.0);
    const float _e93 = student_t_impl_min(_e91, 0.0);
    const float3 _e98 = student_t_impl_mirror(mu_2);
    return (float3(_e93, moments_1.yz) + ((1.0 + _e93) * _e98));
}

float3 student_t_impl_moments(StudentTImplAlbedo a_9, float cos_theta_1, uint masking_6)
{
    float power = 1.0;
    float more = 0.0;
    float nearer = 1.0;

    const float _e3 = student_t_impl_unit(cos_theta_1);
    if (!((a_9.sigma > 0.0))) {
        const float3 _e8 = student_t_impl_mirror(_e3);
        return _e8;
    }
    const float3 _e11 = student_t_impl_moments_at(a_9, max(_e3, a_9.lowest));
    if (!((_e3 < a_9.lowest))) {
        return _e11;
    }
    if (!((_e11.x < 0.0))) {
        const float3 _e19 = student_t_impl_mirror(_e3);
        return _e19;
    }
    const float3 _e23 = student_t_impl_moments_at(a_9, (4.0 * a_9.lowest));
    if ((masking_6 != STUDENT_T_UNCORRELATED)) {
        float ratio = (_e23.x / _e11.x);
        power = 0.0;
        if ((ratio > 1.0)) {
            const float _e34 = student_t_impl_log(ratio);
            power = min((0.7213475 * _e34), 1.0);
        }
    }
    float _e41 = power;
    if ((_e41 > 0.0)) {
        if ((_e3 > 0.0)) {
            float _e48 = power;
            const float _e53 = student_t_impl_exp_growth((_e48 * log((_e3 / a_9.lowest))));
            nearer = -(_e53);
        }
        float _e55 = nearer;
        float _e56 = power;
        const float _e59 = student_t_impl_exp_growth((_e56 * 1.3862944));
        more = (_e55 / _e59);
    }
    float _e61 = more;
    float3 limit = (_e11 + (_e61 * (_e11 - _e23)));
    const float _e67 = student_t_impl_max(limit.x, -1.0);
    const float _e69 = student_t_impl_min(_e67, 0.0);
    return float3(_e69, limit.yz);
}

float student_t_impl_lost(StudentTImplAlbedo a_10, float cos_theta_2, uint masking_7)
{
    const float3 _e3 = student_t_impl_moments(a_10, cos_theta_2, masking_7);
    return -(_e3.x);
}

float student_t_lobe_albedo(StudentTLobe lobe_20, float cos_theta_3, uint masking_8)
{
    const StudentTImplAlbedo _e3 = student_t_impl_albedo_of(lobe_20, masking_8);
    const float _e4 = student_t_impl_lost(_e3, cos_theta_3, masking_8);
    return (1.0 - _e4);
}

float3 student_t_lobe_albedo_parts(StudentTLobe lobe_21, float cos_theta_4, uint masking_9)
{
    const StudentTImplAlbedo _e3 = student_t_impl_albedo_of(lobe_21, masking_9);
    const float3 _e4 = student_t_impl_moments(_e3, cos_theta_4, masking_9);
    const float3 _e10 = student_t_impl_limit(float3((1.0 + _e4.x), _e4.yz));
    return _e10;
}

float3 student_t_impl_averages(StudentTImplAlbedo a_11)
{
    if (!((a_11.sigma > 0.0))) {
        const float3 _e5 = student_t_impl_mirror_average();
        return _e5;
    }
    float count = a_11.table.average_sigmas;
    const StudentTImplSix _e12 = student_t_impl_six((a_11.coordinate * (count - 1.0)), count);
    const float3 _e21 = student_t_impl_row((a_11.table.averages + (2u * _e12.start)), _e12, (0.0).xxx);
    return float3(min(exp(_e21.x), 1.0), _e21.yz);
}

float student_t_lobe_albedo_average(StudentTLobe lobe_22, uint masking_10)
{
    const StudentTImplAlbedo _e2 = student_t_impl_albedo_of(lobe_22, masking_10);
    const float3 _e3 = student_t_impl_averages(_e2);
    return (1.0 - _e3.x);
}

float3 student_t_lobe_albedo_average_parts(StudentTLobe lobe_23, uint masking_11)
{
    const StudentTImplAlbedo _e2 = student_t_impl_albedo_of(lobe_23, masking_11);
    const float3 _e3 = student_t_impl_averages(_e2);
    const float3 _e9 = student_t_impl_limit(float3((1.0 - _e3.x), _e3.yz));
    return _e9;
}

float student_t_impl_kulla_conty(float lost_v, float lost_l, float average)
{
    if (!((average > 1.1754944e-38))) {
        return 0.0;
    }
    return (((0.31830987 * lost_v) * lost_l) / average);
}

float student_t_lobe_compensation(StudentTLobe lobe_24, float3 v_10, float3 l_3, uint masking_12)
{
    bool local_9 = (bool)0;

    if ((v_10.z > 0.0)) {
        local_9 = (l_3.z > 0.0);
    } else {
        local_9 = false;
    }
    bool _e13 = local_9;
    if (!(_e13)) {
        return 0.0;
    }
    const StudentTImplAlbedo _e16 = student_t_impl_albedo_of(lobe_24, masking_12);
    const float _e18 = student_t_impl_lost(_e16, v_10.z, masking_12);
    const float _e20 = student_t_impl_lost(_e16, l_3.z, masking_12);
    const float3 _e21 = student_t_impl_averages(_e16);
    const float _e23 = student_t_impl_kulla_conty(_e18, _e20, _e21.x);
    return _e23;
}

float student_t_compensation_from(float e_v, float e_l, float e_average)
{
    const float _e9 = student_t_impl_kulla_conty((1.0 - e_v), (1.0 - e_l), (1.0 - e_average));
    return _e9;
}

float student_t_d(uint shape_2, float2 sigma_7, float3 m_7)
{
    const StudentTLobe _e3 = student_t_lobe_of(shape_2, sigma_7);
    const float _e4 = student_t_lobe_d(_e3, m_7);
    return _e4;
}

float student_t_masking(uint shape_3, float2 sigma_8, float3 w_5)
{
    const StudentTLobe _e3 = student_t_lobe_of(shape_3, sigma_8);
    const float _e4 = student_t_lobe_masking(_e3, w_5);
    return _e4;
}

float student_t_lambda(uint shape_4, float2 sigma_9, float3 w_6)
{
    const StudentTLobe _e3 = student_t_lobe_of(shape_4, sigma_9);
    const float _e4 = student_t_lobe_lambda(_e3, w_6);
    return _e4;
}

float student_t_masking_shadowing(uint shape_5, float2 sigma_10, float3 v_11, float3 l_4, uint masking_13)
{
    const StudentTLobe _e5 = student_t_lobe_of(shape_5, sigma_10);
    const float _e6 = student_t_lobe_masking_shadowing(_e5, v_11, l_4, masking_13);
    return _e6;
}

float student_t_reflection_weight(uint shape_6, float2 sigma_11, float3 v_12, float3 l_5, uint masking_14)
{
    const StudentTLobe _e5 = student_t_lobe_of(shape_6, sigma_11);
    const float _e6 = student_t_lobe_reflection_weight(_e5, v_12, l_5, masking_14);
    return _e6;
}

float3 student_t_sample_visible_normal(uint shape_7, float2 sigma_12, float3 v_13, float2 u_6)
{
    const StudentTLobe _e4 = student_t_lobe_of(shape_7, sigma_12);
    const float3 _e5 = student_t_lobe_sample_visible_normal(_e4, v_13, u_6);
    return _e5;
}

float student_t_visible_normal_pdf(uint shape_8, float2 sigma_13, float3 v_14, float3 m_8)
{
    const StudentTLobe _e4 = student_t_lobe_of(shape_8, sigma_13);
    const float _e5 = student_t_lobe_visible_normal_pdf(_e4, v_14, m_8);
    return _e5;
}

float student_t_reflection_pdf(uint shape_9, float2 sigma_14, float3 v_15, float3 m_9)
{
    const StudentTLobe _e4 = student_t_lobe_of(shape_9, sigma_14);
    const float _e5 = student_t_lobe_reflection_pdf(_e4, v_15, m_9);
    return _e5;
}

float student_t_albedo(uint shape_10, float2 sigma_15, float cos_theta_5, uint masking_15)
{
    const StudentTLobe _e4 = student_t_lobe_of(shape_10, sigma_15);
    const float _e5 = student_t_lobe_albedo(_e4, cos_theta_5, masking_15);
    return _e5;
}

float3 student_t_albedo_parts(uint shape_11, float2 sigma_16, float cos_theta_6, uint masking_16)
{
    const StudentTLobe _e4 = student_t_lobe_of(shape_11, sigma_16);
    const float3 _e5 = student_t_lobe_albedo_parts(_e4, cos_theta_6, masking_16);
    return _e5;
}

float student_t_albedo_average(uint shape_12, float2 sigma_17, uint masking_17)
{
    const StudentTLobe _e3 = student_t_lobe_of(shape_12, sigma_17);
    const float _e4 = student_t_lobe_albedo_average(_e3, masking_17);
    return _e4;
}

float3 student_t_albedo_average_parts(uint shape_13, float2 sigma_18, uint masking_18)
{
    const StudentTLobe _e3 = student_t_lobe_of(shape_13, sigma_18);
    const float3 _e4 = student_t_lobe_albedo_average_parts(_e3, masking_18);
    return _e4;
}

float student_t_compensation(uint shape_14, float2 sigma_19, float3 v_16, float3 l_6, uint masking_19)
{
    const StudentTLobe _e5 = student_t_lobe_of(shape_14, sigma_19);
    const float _e6 = student_t_lobe_compensation(_e5, v_16, l_6, masking_19);
    return _e6;
}

#endif
