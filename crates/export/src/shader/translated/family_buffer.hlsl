#ifndef STUDENT_T
#define STUDENT_T

#ifndef STUDENT_T_REGISTER
#define STUDENT_T_REGISTER t0
#endif

struct StudentTImplWindow {
    uint start;
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float4 weights;
};

struct StudentTLobe {
    float2 sigma;
    float gamma;
    bool is_mirror;
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
    int _pad22_0;
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
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float3 weights;
    int _end_pad_0;
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
    int _pad1_0;
    int _pad1_1;
    int _pad1_2;
    float4 weights;
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

static const uint STUDENT_T_IMPL_PARTS = 5u;
static const uint STUDENT_T_IMPL_PART = 33u;
static const uint STUDENT_T_IMPL_VOLUMES = 71u;
static const uint STUDENT_T_IMPL_VOLUME = 28u;
static const uint STUDENT_T_IMPL_BETWEEN = 53u;
static const uint STUDENT_T_IMPL_ROWS = 16u;
static const uint STUDENT_T_IMPL_SHAPES = 37u;
static const uint STUDENT_T_IMPL_VIEWS = 29u;
static const uint STUDENT_T_UNCORRELATED = 0u;
static const uint STUDENT_T_HEIGHT_CORRELATED = 1u;

ByteAddressBuffer student_t_tables : register(STUDENT_T_REGISTER);

uint student_t_impl_word(uint at)
{
    uint _e3 = asuint(student_t_tables.Load(at*4));
    return _e3;
}

float student_t_impl_float(uint at_1)
{
    const uint _e1 = student_t_impl_word(at_1);
    return asfloat(_e1);
}

float4 student_t_impl_four(uint at_2)
{
    const float _e1 = student_t_impl_float(at_2);
    const float _e4 = student_t_impl_float((at_2 + 1u));
    const float _e7 = student_t_impl_float((at_2 + 2u));
    const float _e10 = student_t_impl_float((at_2 + 3u));
    return float4(_e1, _e4, _e7, _e10);
}

uint student_t_impl_table(uint at_3)
{
    const uint _e1 = student_t_impl_word(at_3);
    return (_e1 >> 2u);
}

float2 student_t_impl_codes(uint at_4)
{
    const uint _e1 = student_t_impl_word(at_4);
    return float2(float((_e1 & 65535u)), float((_e1 >> 16u)));
}

StudentTImplWindow ConstructStudentTImplWindow(uint arg0, float4 arg1) {
    StudentTImplWindow ret = (StudentTImplWindow)0;
    ret.start = arg0;
    ret.weights = arg1;
    return ret;
}

StudentTImplWindow student_t_impl_window(uint between, uint table, float x)
{
    uint at_9 = ((between + 5u) + (16u * table));
    const float4 _e8 = student_t_impl_four(at_9);
    const float4 _e11 = student_t_impl_four((at_9 + 4u));
    float4 low = (_e8 + (x * _e11));
    const float4 _e16 = student_t_impl_four((at_9 + 8u));
    const float4 _e19 = student_t_impl_four((at_9 + 12u));
    float4 high = (_e16 + (x * _e19));
    const uint _e25 = student_t_impl_word(((between + 2u) + table));
    const StudentTImplWindow studenttimplwindow = ConstructStudentTImplWindow(_e25, (low + ((x * x) * high)));
    return studenttimplwindow;
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

StudentTLobe ConstructStudentTLobe(float2 arg0, float arg1, bool arg2, float arg3, float arg4, float arg5, float arg6, float arg7, float arg8, float arg9, float arg10, float arg11, float arg12, float arg13, float arg14, float arg15, float arg16, float arg17, float arg18, float arg19, float arg20, uint arg21, StudentTImplWindow arg22, StudentTImplWindow arg23, StudentTImplWindow arg24) {
    StudentTLobe ret = (StudentTLobe)0;
    ret.sigma = arg0;
    ret.gamma = arg1;
    ret.is_mirror = arg2;
    ret.is_ggx = arg3;
    ret.s = arg4;
    ret.d_s = arg5;
    ret.d_power = arg6;
    ret.kappa = arg7;
    ret.heavy_exponent = arg8;
    ret.heavy_root_s = arg9;
    ret.masking_crowded = arg10;
    ret.masking_cells = arg11;
    ret.rows = arg12;
    ret.rows_first = arg13;
    ret.rows_second = arg14;
    ret.rows_second_end = arg15;
    ret.rows_third = arg16;
    ret.numbers = arg17;
    ret.along_scale = arg18;
    ret.across_scale = arg19;
    ret.heavy_per_row = arg20;
    ret.part = arg21;
    ret.slopes = arg22;
    ret.across = arg23;
    ret.masking = arg24;
    return ret;
}

uint student_t_impl_f2u32(float value) {
    return uint(clamp(value, 0.0, 4294967000.0));
}

StudentTLobe student_t_lobe_at(float gamma, float2 sigma_1)
{
    bool local = (bool)0;
    uint cell = (uint)0;
    bool local_1 = (bool)0;

    const uint _e3 = student_t_impl_word(4u);
    bool has_two = (_e3 > 1u);
    if (has_two) {
        const float _e9 = student_t_impl_float(3u);
        local = !((gamma >= _e9));
    } else {
        local = false;
    }
    bool second_1 = local;
    uint part = (STUDENT_T_IMPL_PARTS + (second_1 ? STUDENT_T_IMPL_PART : 0u));
    const float _e21 = student_t_impl_float((part + 1u));
    const float _e23 = student_t_impl_min(_e21, 1e18);
    const float _e24 = student_t_impl_float(part);
    const float _e25 = student_t_impl_max(gamma, _e24);
    const float _e26 = student_t_impl_min(_e25, _e23);
    float less = (_e26 - 1.0);
    float twice = ((2.0 * _e26) - 3.0);
    float s_1 = (1.0 / less);
    float exponent = (1.0 / twice);
    float r = (twice * s_1);
    const float _e40 = student_t_impl_float((part + 14u));
    const float _e44 = student_t_impl_float((part + 15u));
    const float _e47 = student_t_impl_max(((_e40 - r) * _e44), 0.0);
    const uint _e50 = student_t_impl_word((part + 17u));
    cell = _e50;
    const uint _e54 = student_t_impl_word((part + 16u));
    if ((_e47 < float(_e54))) {
        uint at_10 = student_t_impl_f2u32(_e47);
        const uint _e60 = student_t_impl_table((part + 18u));
        const float2 _e64 = student_t_impl_codes((_e60 + (at_10 >> 1u)));
        cell = student_t_impl_f2u32((((at_10 & 1u) > 0u) ? _e64.y : _e64.x));
    }
    const uint _e75 = student_t_impl_table((part + 19u));
    uint _e77 = cell;
    uint between_1 = (_e75 + (STUDENT_T_IMPL_BETWEEN * _e77));
    const float _e80 = student_t_impl_float(between_1);
    const float _e84 = student_t_impl_float((between_1 + 1u));
    float x_9 = ((_e80 - r) * _e84);
    const float _e87 = student_t_impl_sigma(sigma_1.x);
    const float _e89 = student_t_impl_sigma(sigma_1.y);
    if ((sigma_1.x > 0.0)) {
        local_1 = (sigma_1.y > 0.0);
    } else {
        local_1 = false;
    }
    bool _e100 = local_1;
    const float _e103 = student_t_impl_max(s_1, 9.094947e-13);
    const float _e105 = student_t_impl_min(less, 1099511600000.0);
    const float _e112 = student_t_impl_float((part + 2u));
    const uint _e118 = student_t_impl_word((part + 3u));
    const float _e122 = student_t_impl_float((part + 4u));
    const float _e125 = student_t_impl_float((part + 5u));
    const float _e128 = student_t_impl_float((part + 6u));
    const float _e131 = student_t_impl_float((part + 7u));
    const float _e134 = student_t_impl_float((part + 8u));
    const float _e137 = student_t_impl_float((part + 9u));
    const uint _e140 = student_t_impl_word((part + 10u));
    const float _e144 = student_t_impl_float((part + 11u));
    const float _e147 = student_t_impl_float((part + 12u));
    const float _e150 = student_t_impl_float((part + 13u));
    const StudentTImplWindow _e152 = student_t_impl_window(between_1, 0u, x_9);
    const StudentTImplWindow _e154 = student_t_impl_window(between_1, 1u, x_9);
    const StudentTImplWindow _e156 = student_t_impl_window(between_1, 2u, x_9);
    const StudentTLobe studenttlobe = ConstructStudentTLobe(float2(_e87, _e89), _e26, !(_e100), 0.0, s_1, _e103, (0.5 - (0.5 * _e105)), (_e112 * (less * exponent)), exponent, sqrt(s_1), float(_e118), _e122, _e125, _e128, _e131, _e134, _e137, float(_e140), _e144, _e147, _e150, part, _e152, _e154, _e156);
    return studenttlobe;
}

float2 student_t_impl_sum(uint at_5, uint step_, float4 w)
{
    const float2 _e4 = student_t_impl_codes(at_5);
    const float2 _e8 = student_t_impl_codes((at_5 + step_));
    const float2 _e15 = student_t_impl_codes((at_5 + (2u * step_)));
    const float2 _e21 = student_t_impl_codes((at_5 + (3u * step_)));
    return (((w.x * _e4) + (w.y * _e8)) + ((w.z * _e15) + (w.w * _e21)));
}

float2 student_t_impl_node_of(uint table_1, uint shapes, StudentTImplWindow window, uint place)
{
    const uint _e4 = student_t_impl_table(table_1);
    uint codes = ((_e4 + (place * shapes)) + window.start);
    const uint _e11 = student_t_impl_table((table_1 + 1u));
    const float4 _e15 = student_t_impl_four((_e11 + (4u * place)));
    const float2 _e20 = student_t_impl_sum(codes, 1u, window.weights);
    return (_e15.xz + (_e15.yw * _e20));
}

float student_t_impl_hermite(float2 a_2, float2 b_2, float w_1)
{
    float value_a = (1.0 + (w_1 * (w_1 * ((w_1 * 2.0) - 3.0))));
    float slope_a = (w_1 * (1.0 + (w_1 * (w_1 - 2.0))));
    float value_b = (w_1 * (w_1 * (3.0 - (w_1 * 2.0))));
    float slope_b = (w_1 * (w_1 * (w_1 - 1.0)));
    return (((a_2.x * value_a) + (b_2.x * value_b)) + ((a_2.y * slope_a) + (b_2.y * slope_b)));
}

float student_t_impl_cell_of(uint table_2, uint shapes_1, StudentTImplWindow window_1, StudentTImplPlace place_1)
{
    const float2 _e5 = student_t_impl_node_of(table_2, shapes_1, window_1, place_1.cell);
    const float2 _e9 = student_t_impl_node_of(table_2, shapes_1, window_1, (place_1.cell + 1u));
    const float _e11 = student_t_impl_hermite(_e5, _e9, place_1.position);
    return _e11;
}

float student_t_impl_masking_at(StudentTLobe lobe, StudentTImplPlace place_2)
{
    const uint _e5 = student_t_impl_word((lobe.part + 22u));
    const float _e10 = student_t_impl_cell_of((lobe.part + 27u), _e5, lobe.masking, place_2);
    return _e10;
}

float student_t_impl_across_at(StudentTLobe lobe_1, StudentTImplPlace place_3)
{
    const uint _e5 = student_t_impl_word((lobe_1.part + 21u));
    const float _e10 = student_t_impl_cell_of((lobe_1.part + 25u), _e5, lobe_1.across, place_3);
    return _e10;
}

uint student_t_impl_div(uint lhs, uint rhs) {
    return lhs / (rhs == 0u ? 1u : rhs);
}

float2 student_t_impl_slopes_of(StudentTLobe lobe_2, uint row, uint column)
{
    uint numbers = (2u * student_t_impl_f2u32(lobe_2.numbers));
    const uint _e10 = student_t_impl_word((lobe_2.part + 20u));
    const uint _e14 = student_t_impl_table((lobe_2.part + 23u));
    uint at_11 = ((_e14 + (((row * numbers) + column) * _e10)) + lobe_2.slopes.start);
    const float2 _e22 = student_t_impl_codes(at_11);
    const float2 _e25 = student_t_impl_codes((at_11 + 1u));
    const float2 _e28 = student_t_impl_codes((at_11 + 2u));
    const float2 _e31 = student_t_impl_codes((at_11 + 3u));
    float4 w_6 = lobe_2.slopes.weights;
    float2 sum_3 = (((w_6.x * _e22) + (w_6.y * _e25)) + ((w_6.z * _e28) + (w_6.w * _e31)));
    float squares = ((((w_6.x * _e22.x) * _e22.x) + ((w_6.y * _e25.x) * _e25.x)) + (((w_6.z * _e28.x) * _e28.x) + ((w_6.w * _e31.x) * _e31.x)));
    const uint _e71 = student_t_impl_table((lobe_2.part + 24u));
    uint steps = (_e71 + (5u * ((student_t_impl_div(row, STUDENT_T_IMPL_ROWS) * (numbers + 1u)) + column)));
    const float4 _e81 = student_t_impl_four(steps);
    float value = ((_e81.x + (_e81.y * sum_3.x)) + (_e81.z * squares));
    const float _e93 = student_t_impl_float((steps + 4u));
    return float2(value, (_e81.w + (_e93 * sum_3.y)));
}

float student_t_impl_along_at(StudentTLobe lobe_3, StudentTImplPlace view, uint second, StudentTImplPlace number)
{
    float2 a_3 = (float2)0;
    float2 b_3 = (float2)0;

    uint column_1 = ((second * student_t_impl_f2u32(lobe_3.numbers)) + number.cell);
    uint next = min((view.cell + 1u), student_t_impl_f2u32(lobe_3.rows));
    const float2 _e16 = student_t_impl_slopes_of(lobe_3, view.cell, column_1);
    a_3 = _e16;
    const float2 _e21 = student_t_impl_slopes_of(lobe_3, view.cell, (column_1 + 1u));
    b_3 = _e21;
    float2 _e23 = a_3;
    const float2 _e25 = student_t_impl_slopes_of(lobe_3, next, column_1);
    float2 _e26 = a_3;
    a_3 = (_e23 + (view.position * (_e25 - _e26)));
    float2 _e30 = b_3;
    const float2 _e34 = student_t_impl_slopes_of(lobe_3, next, (column_1 + 1u));
    float2 _e35 = b_3;
    b_3 = (_e30 + (view.position * (_e34 - _e35)));
    float _e40 = b_3.x;
    float _e42 = a_3.x;
    const float _e47 = student_t_impl_max((3.0 * (_e40 - _e42)), 0.0);
    float _e49 = a_3.x;
    const float _e51 = student_t_impl_max(_e49, 0.0);
    float _e53 = a_3.y;
    const float _e55 = student_t_impl_max(_e53, 0.0);
    const float _e56 = student_t_impl_min(_e55, _e47);
    a_3 = float2(_e51, _e56);
    float _e59 = b_3.x;
    const float _e61 = student_t_impl_max(_e59, 0.0);
    float _e63 = b_3.y;
    const float _e65 = student_t_impl_max(_e63, 0.0);
    const float _e66 = student_t_impl_min(_e65, _e47);
    b_3 = float2(_e61, _e66);
    float2 _e68 = a_3;
    float2 _e69 = b_3;
    const float _e71 = student_t_impl_hermite(_e68, _e69, number.position);
    return _e71;
}

float2 student_t_impl_share_at(StudentTLobe lobe_4, StudentTImplPlace place_4)
{
    uint start = lobe_4.masking.start;
    const uint _e7 = student_t_impl_table((lobe_4.part + 31u));
    const float4 _e9 = student_t_impl_four((_e7 + start));
    float4 w_7 = (lobe_4.masking.weights * _e9);
    float all_ = ((w_7.x + w_7.y) + (w_7.z + w_7.w));
    const uint _e23 = student_t_impl_word((lobe_4.part + 22u));
    const uint _e27 = student_t_impl_table((lobe_4.part + 29u));
    uint codes_1 = (_e27 + (2u * ((place_4.cell * _e23) + start)));
    const uint _e37 = student_t_impl_table((lobe_4.part + 30u));
    uint columns = (_e37 + (8u * place_4.cell));
    const float4 _e42 = student_t_impl_four(columns);
    const float4 _e45 = student_t_impl_four((columns + 4u));
    const float2 _e50 = student_t_impl_sum(codes_1, 2u, w_7);
    float2 a_15 = ((_e42.xz * all_) + (_e42.yw * _e50));
    const float2 _e59 = student_t_impl_sum((codes_1 + 1u), 2u, w_7);
    float2 b_7 = ((_e45.xz * all_) + (_e45.yw * _e59));
    float x_10 = place_4.position;
    float area = ((a_15.x + (x_10 * a_15.y)) + ((x_10 * x_10) * (b_7.x + (x_10 * b_7.y))));
    const float _e75 = student_t_impl_max(area, 1.1754944e-38);
    const uint _e79 = student_t_impl_table((lobe_4.part + 32u));
    const float4 _e84 = student_t_impl_four((_e79 + (4u * place_4.cell)));
    const float _e97 = student_t_impl_max(((_e84.x + (x_10 * _e84.y)) + ((x_10 * x_10) * (_e84.z + (x_10 * _e84.w)))), 0.0);
    return (float2(_e97, _e75) / ((_e97 + _e75)).xx);
}

float student_t_impl_octaves(float x_1)
{
    uint bits = asuint(x_1);
    float m_7 = ((x_1 * asfloat(((254u - (bits >> 23u)) << 23u))) - 1.0);
    return ((float((bits >> 23u)) - 127.0) + ((m_7 * ((m_7 * (m_7 - 4.0)) + 10.0)) * 0.14285715));
}

StudentTImplThree ConstructStudentTImplThree(uint arg0, float3 arg1) {
    StudentTImplThree ret = (StudentTImplThree)0;
    ret.start = arg0;
    ret.weights = arg1;
    return ret;
}

StudentTImplThree student_t_impl_three(float x_2)
{
    const float _e2 = student_t_impl_max(x_2, 0.0);
    float start_1 = floor((_e2 + 0.5));
    float d_1 = (x_2 - start_1);
    float half_d = (0.5 * d_1);
    float ends = ((half_d * d_1) + 0.125);
    const StudentTImplThree studenttimplthree = ConstructStudentTImplThree(student_t_impl_f2u32(start_1), float3((ends - half_d), (1.0 - (ends + ends)), (ends + half_d)));
    return studenttimplthree;
}

StudentTImplAlbedo ConstructStudentTImplAlbedo(uint arg0, float arg1, float arg2, float arg3, StudentTImplThree arg4, StudentTImplThree arg5) {
    StudentTImplAlbedo ret = (StudentTImplAlbedo)0;
    ret.volume = arg0;
    ret.sigma = arg1;
    ret.less = arg2;
    ret.coordinate = arg3;
    ret.by_shape = arg4;
    ret.by_sigma = arg5;
    return ret;
}

StudentTImplAlbedo student_t_impl_albedo_of(StudentTLobe lobe_5, uint masking)
{
    bool local_2 = (bool)0;

    uint form = ((masking == STUDENT_T_UNCORRELATED) ? 0u : STUDENT_T_IMPL_VOLUME);
    uint t = (STUDENT_T_IMPL_VOLUMES + form);
    const float4 _e9 = student_t_impl_four(t);
    const float4 _e12 = student_t_impl_four((t + 4u));
    const float _e15 = student_t_impl_float((t + 8u));
    const float _e18 = student_t_impl_float((t + 9u));
    float2 averages = float2(_e15, _e18);
    float stand_in = sqrt((lobe_5.sigma.x * lobe_5.sigma.y));
    const float _e27 = student_t_impl_max(stand_in, _e9.z);
    const float _e29 = student_t_impl_min(_e27, _e9.w);
    float twice_1 = ((2.0 * lobe_5.gamma) - 3.0);
    const float _e36 = student_t_impl_max(twice_1, _e9.x);
    const float _e38 = student_t_impl_min(_e36, _e9.y);
    const float _e39 = student_t_impl_octaves(_e29);
    float shape = sqrt(sqrt((_e38 / (_e38 + 3.0))));
    const float _e49 = student_t_impl_octaves((1.0 + (60.0 * _e29)));
    float sigma_7 = ((_e49 + (0.2 * _e39)) + _e29);
    if (!(lobe_5.is_mirror)) {
        const uint _e60 = student_t_impl_word((t + 22u));
        local_2 = (_e60 == 0u);
    } else {
        local_2 = true;
    }
    bool mirror = local_2;
    const StudentTImplThree _e78 = student_t_impl_three(((shape - _e12.x) * _e12.z));
    const StudentTImplThree _e83 = student_t_impl_three(((sigma_7 - _e12.y) * _e12.w));
    const StudentTImplAlbedo studenttimplalbedo = ConstructStudentTImplAlbedo(t, (mirror ? 0.0 : _e29), _e38, (((_e39 + (2.0 * _e29)) - averages.x) * averages.y), _e78, _e83);
    return studenttimplalbedo;
}

float4 student_t_impl_row(uint at_6)
{
    uint word = (at_6 >> 1u);
    uint odd = (at_6 & 1u);
    const float2 _e5 = student_t_impl_codes(word);
    const float2 _e8 = student_t_impl_codes((word + 1u));
    const float2 _e12 = student_t_impl_codes(((word + 1u) + odd));
    return ((odd > 0u) ? float4(_e5.y, _e8, _e12.x) : float4(_e5, _e8));
}

StudentTImplPlace ConstructStudentTImplPlace(uint arg0, float arg1) {
    StudentTImplPlace ret = (StudentTImplPlace)0;
    ret.cell = arg0;
    ret.position = arg1;
    return ret;
}

StudentTImplPlace student_t_impl_place(float x_3, float last)
{
    uint cell_1 = min(student_t_impl_f2u32(x_3), student_t_impl_f2u32(last));
    const StudentTImplPlace studenttimplplace = ConstructStudentTImplPlace(cell_1, (x_3 - float(cell_1)));
    return studenttimplplace;
}

StudentTImplViews ConstructStudentTImplViews(uint arg0, float4 arg1) {
    StudentTImplViews ret = (StudentTImplViews)0;
    ret.cell = arg0;
    ret.weights = arg1;
    return ret;
}

StudentTImplViews student_t_impl_views(StudentTImplAlbedo a_4, float mu)
{
    float d_2 = a_4.less;
    float sine = sqrt(max(((1.0 - mu) * (1.0 + mu)), 0.0));
    float x_11 = ((d_2 * mu) / ((d_2 * mu) + ((((6.0 * a_4.sigma) * d_2) + a_4.sigma) * sine)));
    float h = (mu / (1.0 + sine));
    const StudentTImplPlace _e35 = student_t_impl_place(((14.3 * sqrt(sqrt(x_11))) + (11.7 * sqrt(sqrt(h)))), 25.0);
    float t_1 = _e35.position;
    float rest_1 = (1.0 - t_1);
    const StudentTImplViews studenttimplviews = ConstructStudentTImplViews(_e35.cell, float4((((rest_1 * rest_1) * rest_1) * 0.16666667), (0.6666667 - ((t_1 * t_1) * (1.0 - (0.5 * t_1)))), (0.6666667 - ((rest_1 * rest_1) * (1.0 - (0.5 * rest_1)))), (((t_1 * t_1) * t_1) * 0.16666667)));
    return studenttimplviews;
}

float student_t_impl_decoded(StudentTImplAlbedo a_5, uint channel, float sum)
{
    const float _e7 = student_t_impl_float(((a_5.volume + 10u) + channel));
    const float _e12 = student_t_impl_float(((a_5.volume + 16u) + channel));
    return (_e7 + (_e12 * sum));
}

float student_t_impl_channel(StudentTImplAlbedo a_6, uint channel_1, StudentTImplViews views)
{
    float4 sum_1 = (0.0).xxxx;
    uint i = 0u;

    const uint _e7 = student_t_impl_word(((a_6.volume + 22u) + channel_1));
    uint first = (((_e7 >> 1u) + (((a_6.by_sigma.start * STUDENT_T_IMPL_SHAPES) + a_6.by_shape.start) * STUDENT_T_IMPL_VIEWS)) + views.cell);
    uint2 loop_bound = uint2(4294967295u, 4294967295u);
    bool loop_init = true;
    while(true) {
        if (all(loop_bound == uint2(0u, 0u))) { break; }
        loop_bound -= uint2(loop_bound.y == 0u, 1u);
        if (!loop_init) {
            uint _e59 = i;
            i = (_e59 + 1u);
        }
        loop_init = false;
        uint _e27 = i;
        if ((_e27 < 3u)) {
        } else {
            break;
        }
        {
            uint _e30 = i;
            uint row_1 = (first + (_e30 * 1073u));
            float3 w_8 = a_6.by_shape.weights;
            const float4 _e37 = student_t_impl_row(row_1);
            const float4 _e42 = student_t_impl_row((row_1 + STUDENT_T_IMPL_VIEWS));
            const float4 _e48 = student_t_impl_row((row_1 + 58u));
            float4 codes_2 = (((w_8.x * _e37) + (w_8.y * _e42)) + (w_8.z * _e48));
            float4 _e51 = sum_1;
            uint _e54 = i;
            sum_1 = (_e51 + (a_6.by_sigma.weights[min(uint(_e54), 2u)] * codes_2));
        }
    }
    float4 _e61 = sum_1;
    const float _e64 = student_t_impl_decoded(a_6, channel_1, dot(_e61, views.weights));
    return _e64;
}

float student_t_impl_lost_at(StudentTImplAlbedo a_7, StudentTImplViews views_1)
{
    const float _e3 = student_t_impl_channel(a_7, 0u, views_1);
    return min((_e3 * _e3), 1.0);
}

float student_t_impl_unit(float x_4)
{
    const float _e2 = student_t_impl_max(x_4, 0.0);
    const float _e4 = student_t_impl_min(_e2, 1.0);
    return _e4;
}

float student_t_impl_lost(StudentTImplAlbedo a_8, float cos_theta, uint masking_1)
{
    if (!((a_8.sigma > 0.0))) {
        return 0.0;
    }
    const float _e8 = student_t_impl_unit(cos_theta);
    const StudentTImplViews _e9 = student_t_impl_views(a_8, _e8);
    const float _e10 = student_t_impl_lost_at(a_8, _e9);
    return _e10;
}

float3 student_t_impl_mirror(float mu_1)
{
    float k = (1.0 - mu_1);
    float fourth = ((k * k) * (k * k));
    return float3(0.0, (fourth * k), ((17.651384 * mu_1) * (fourth * (k * k))));
}

float3 student_t_impl_moments(StudentTImplAlbedo a_9, float cos_theta_1, uint masking_2)
{
    const float _e3 = student_t_impl_unit(cos_theta_1);
    const float3 _e4 = student_t_impl_mirror(_e3);
    if (!((a_9.sigma > 0.0))) {
        return _e4;
    }
    const StudentTImplViews _e9 = student_t_impl_views(a_9, _e3);
    const float _e10 = student_t_impl_lost_at(a_9, _e9);
    const float _e12 = student_t_impl_channel(a_9, 1u, _e9);
    const float _e14 = student_t_impl_channel(a_9, 2u, _e9);
    return (float3(-(_e10), _e12, _e14) + ((1.0 - _e10) * _e4));
}

float student_t_impl_average(StudentTImplAlbedo a_10, uint channel_2, StudentTImplThree by_sigma)
{
    float sum_2 = 0.0;
    uint i_1 = 0u;

    const uint _e7 = student_t_impl_word(((a_10.volume + 22u) + channel_2));
    uint first_1 = (((_e7 >> 1u) + (by_sigma.start * STUDENT_T_IMPL_SHAPES)) + a_10.by_shape.start);
    uint2 loop_bound_1 = uint2(4294967295u, 4294967295u);
    bool loop_init_1 = true;
    while(true) {
        if (all(loop_bound_1 == uint2(0u, 0u))) { break; }
        loop_bound_1 -= uint2(loop_bound_1.y == 0u, 1u);
        if (!loop_init_1) {
            uint _e45 = i_1;
            i_1 = (_e45 + 1u);
        }
        loop_init_1 = false;
        uint _e21 = i_1;
        if ((_e21 < 3u)) {
        } else {
            break;
        }
        {
            uint _e24 = i_1;
            const float4 _e28 = student_t_impl_row((first_1 + (_e24 * STUDENT_T_IMPL_SHAPES)));
            float3 codes_3 = (_e28.xyz * a_10.by_shape.weights);
            float _e33 = sum_2;
            uint _e35 = i_1;
            sum_2 = (_e33 + (by_sigma.weights[min(uint(_e35), 2u)] * ((codes_3.x + codes_3.y) + codes_3.z)));
        }
    }
    float _e47 = sum_2;
    const float _e48 = student_t_impl_decoded(a_10, channel_2, _e47);
    return _e48;
}

float3 student_t_impl_mirror_average()
{
    return float3(0.0, 0.04761905, 0.14009036);
}

float3 student_t_impl_averages(StudentTImplAlbedo a_11)
{
    const float3 _e1 = student_t_impl_mirror_average();
    if (!((a_11.sigma > 0.0))) {
        return _e1;
    }
    const StudentTImplThree _e7 = student_t_impl_three(a_11.coordinate);
    const float _e9 = student_t_impl_average(a_11, 3u, _e7);
    if ((_e9 < -120.0)) {
        return _e1;
    }
    float lost = min(exp2(_e9), 1.0);
    const float _e16 = student_t_impl_average(a_11, 4u, _e7);
    const float _e18 = student_t_impl_average(a_11, 5u, _e7);
    return (float3(lost, _e16, _e18) + ((1.0 - lost) * _e1));
}

float student_t_impl_product(float a_12, float b_4)
{
    bool local_3 = (bool)0;

    if ((b_4 > 1.0)) {
        local_3 = (a_12 > (3.402823e38 / b_4));
    } else {
        local_3 = false;
    }
    bool _e10 = local_3;
    if (_e10) {
        return 3.402823e38;
    }
    return (a_12 * b_4);
}

float student_t_impl_log_growth(float x_5)
{
    bool local_4 = (bool)0;

    if ((x_5 >= -0.5)) {
        local_4 = (x_5 <= 1.0);
    } else {
        local_4 = false;
    }
    bool _e8 = local_4;
    if (!(_e8)) {
        return log((1.0 + x_5));
    }
    float y = (x_5 / (2.0 + x_5));
    float q = (y * y);
    float tail = (q * (0.11111111 + (q * (0.09090909 + (q * (0.07692308 + (q * 0.06666667)))))));
    return ((2.0 * y) * (1.0 + (q * (0.33333334 + (q * (0.2 + (q * (0.14285715 + tail))))))));
}

float student_t_impl_log(float x_6)
{
    bool local_5 = (bool)0;

    if ((x_6 >= 0.5)) {
        local_5 = (x_6 <= 2.0);
    } else {
        local_5 = false;
    }
    bool _e8 = local_5;
    if (_e8) {
        const float _e11 = student_t_impl_log_growth((x_6 - 1.0));
        return _e11;
    }
    return log(x_6);
}

float student_t_impl_exp_growth(float x_7)
{
    if ((abs(x_7) > 0.5)) {
        return (exp(x_7) - 1.0);
    }
    float tail_1 = (0.008333334 + (x_7 * (0.0013888889 + (x_7 * (0.0001984127 + (x_7 * 2.4801588e-5))))));
    return (x_7 * (1.0 + (x_7 * (0.5 + (x_7 * (0.16666667 + (x_7 * (0.041666668 + (x_7 * tail_1)))))))));
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

StudentTImplDirection student_t_impl_stretch(float2 sigma_2, float3 w_2)
{
    const float _e3 = student_t_impl_unit(w_2.z);
    float2 xy = (sigma_2 * w_2.xy);
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

float student_t_impl_inverse_area(StudentTLobe lobe_6, StudentTImplDirection d)
{
    float at_7 = (float)0;

    if ((lobe_6.is_ggx > 0.0)) {
        float tall_1 = (d.z + sqrt((d.square + (d.z * d.z))));
        const float _e14 = student_t_impl_max(tall_1, 1.1754944e-38);
        return (2.0 / _e14);
    }
    float across = (lobe_6.kappa * d.rho);
    const float _e23 = student_t_impl_max((d.z + across), 1e-30);
    float r_1 = (lobe_6.masking_cells / _e23);
    at_7 = (d.z * r_1);
    if ((lobe_6.masking_crowded > 0.0)) {
        const float _e33 = student_t_impl_unit((across / _e23));
        at_7 = ((1.0 - sqrt(_e33)) * lobe_6.masking_cells);
    }
    float _e39 = at_7;
    const StudentTImplPlace _e41 = student_t_impl_place(_e39, lobe_6.masking_cells);
    const float _e42 = student_t_impl_masking_at(lobe_6, _e41);
    return (_e42 * r_1);
}

float student_t_impl_dot(float3 a_13, float3 b_5)
{
    return (((a_13.x * b_5.x) + (a_13.y * b_5.y)) + (a_13.z * b_5.z));
}

float3 student_t_impl_raise(float3 m, float shrink)
{
    float r_2 = (1.0 / sqrt((((m.x * m.x) + (m.z * m.z)) + (m.y * m.y))));
    const float _e24 = student_t_impl_max(((m.z * r_2) * shrink), 1e-18);
    return float3((m.x * r_2), (m.y * r_2), _e24);
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

float student_t_impl_d(StudentTLobe lobe_7, float3 m_2, float length_square)
{
    bool local_6 = (bool)0;
    float root = (float)0;
    float growth = (float)0;

    float2 slope_1 = (m_2.xy / lobe_7.sigma);
    float square_1 = (m_2.z * m_2.z);
    float part_1 = (lobe_7.d_s * ((slope_1.x * slope_1.x) + (slope_1.y * slope_1.y)));
    if ((m_2.z > 0.0)) {
        local_6 = (part_1 >= 0.0);
    } else {
        local_6 = false;
    }
    bool _e26 = local_6;
    if (!(_e26)) {
        return 0.0;
    }
    const float _e31 = student_t_impl_max((square_1 + part_1), 1.1754944e-38);
    root = (length_square / _e31);
    if (!((lobe_7.is_ggx > 0.0))) {
        growth = (log(_e31) - (2.0 * log(m_2.z)));
        if ((part_1 < (1000.0 * square_1))) {
            const float _e49 = student_t_impl_log_growth((part_1 / square_1));
            growth = _e49;
        }
        float _e50 = root;
        float _e52 = growth;
        root = (_e50 * exp((lobe_7.d_power * _e52)));
    }
    float scale = sqrt((1.0 / ((3.1415927 * lobe_7.sigma.x) * lobe_7.sigma.y)));
    float _e66 = root;
    float limited = min((scale * min(_e66, 1e30)), 1.8446742e19);
    return (limited * limited);
}

float student_t_lobe_d(StudentTLobe lobe_8, float3 m_3)
{
    const float _e3 = student_t_impl_d(lobe_8, m_3, 1.0);
    return _e3;
}

float student_t_lobe_masking(StudentTLobe lobe_9, float3 w_3)
{
    const StudentTImplDirection _e3 = student_t_impl_stretch(lobe_9.sigma, w_3);
    const float _e5 = student_t_impl_inverse_area(lobe_9, _e3);
    const float _e8 = student_t_impl_min((_e3.z * _e5), 1.0);
    return _e8;
}

float student_t_lobe_lambda(StudentTLobe lobe_10, float3 w_4)
{
    const float _e2 = student_t_lobe_masking(lobe_10, w_4);
    const float _e4 = student_t_impl_max(_e2, 1.1754944e-38);
    return ((1.0 / _e4) - 1.0);
}

float student_t_lobe_masking_shadowing(StudentTLobe lobe_11, float3 v_1, float3 l, uint masking_3)
{
    bool local_7 = (bool)0;

    const float _e4 = student_t_lobe_masking(lobe_11, v_1);
    const float _e5 = student_t_lobe_masking(lobe_11, l);
    float both = (_e4 * _e5);
    float sum_4 = ((_e4 + _e5) - both);
    if (!((masking_3 == STUDENT_T_UNCORRELATED))) {
        local_7 = !((sum_4 > 0.0));
    } else {
        local_7 = true;
    }
    bool _e18 = local_7;
    if (_e18) {
        return both;
    }
    return (both / sum_4);
}

float student_t_impl_weight(float a_14, float b_6, uint masking_4)
{
    if (!((b_6 > 0.0))) {
        return 0.0;
    }
    if ((masking_4 == STUDENT_T_UNCORRELATED)) {
        return b_6;
    }
    return (b_6 / (b_6 + (a_14 * (1.0 - b_6))));
}

float student_t_lobe_reflection_weight(StudentTLobe lobe_12, float3 v_2, float3 l_1, uint masking_5)
{
    if (!((v_2.z > 0.0))) {
        return 0.0;
    }
    const float _e9 = student_t_lobe_masking(lobe_12, v_2);
    const float _e10 = student_t_lobe_masking(lobe_12, l_1);
    const float _e11 = student_t_impl_weight(_e9, _e10, masking_5);
    return _e11;
}

float2 student_t_lobe_eval_pdf(StudentTLobe lobe_13, float3 v_3, float3 l_2, uint masking_6)
{
    bool local_8 = (bool)0;

    if ((v_3.z > 0.0)) {
        local_8 = (l_2.z > 0.0);
    } else {
        local_8 = false;
    }
    bool _e13 = local_8;
    if (!(_e13)) {
        return (0.0).xx;
    }
    float3 both_1 = (v_3 + l_2);
    float3 m_8 = float3(both_1.xy, max(both_1.z, 7.666467e-20));
    const StudentTImplDirection _e24 = student_t_impl_stretch(lobe_13.sigma, v_3);
    const float _e25 = student_t_impl_inverse_area(lobe_13, _e24);
    const float _e29 = student_t_impl_min((_e24.z * _e25), 1.0);
    const float _e30 = student_t_lobe_masking(lobe_13, l_2);
    const float _e31 = student_t_impl_weight(_e29, _e30, masking_6);
    const float _e32 = student_t_impl_dot(m_8, m_8);
    const float _e33 = student_t_impl_d(lobe_13, m_8, _e32);
    float density = (0.25 * _e33);
    const float _e36 = student_t_impl_product(density, _e25);
    const float _e43 = student_t_impl_product((_e31 * _e36), (1.0 / max(l_2.z, 1e-37)));
    return float2(_e43, _e36);
}

bool student_t_effectively_smooth(StudentTLobe lobe_14)
{
    bool local_9 = (bool)0;

    float sigma_8 = max(lobe_14.sigma.x, lobe_14.sigma.y);
    if (!(((0.56 * sigma_8) < 0.001))) {
        return false;
    }
    StudentTImplDirection level = ConstructStudentTImplDirection((0.0).xx, 1.0, 1.0, 0.0, 1.0);
    const float _e19 = student_t_impl_inverse_area(lobe_14, level);
    float mean = (2.0 / _e19);
    float rho_1 = (0.99995 * sigma_8);
    StudentTImplDirection grazing = ConstructStudentTImplDirection((0.0).xx, 1.0, rho_1, 0.01, (rho_1 * rho_1));
    if (((sigma_8 * mean) < 0.001)) {
        const float _e35 = student_t_impl_inverse_area(lobe_14, grazing);
        local_9 = ((1.0 - (0.01 * _e35)) <= 0.0025);
    } else {
        local_9 = false;
    }
    bool _e43 = local_9;
    return _e43;
}

float student_t_impl_sine(float x_8)
{
    float y_1 = (x_8 * x_8);
    float tail_2 = (y_1 * (81.60248 + (y_1 * (-76.58117 + (y_1 * 39.759827)))));
    return (x_8 * (6.2831855 + (y_1 * (-41.34168 + tail_2))));
}

float2 student_t_impl_turn(float u)
{
    float x_12 = (0.5 - u);
    float quarter = (abs(x_12) - 0.25);
    float rest_2 = (0.25 - abs(quarter));
    const float _e9 = student_t_impl_sine(quarter);
    const float _e14 = student_t_impl_sine(((x_12 < 0.0) ? -(rest_2) : rest_2));
    return float2(_e9, _e14);
}

float3 student_t_impl_sample_cap(float2 sigma_3, float3 v_4, float2 u_1)
{
    float3 w_5 = (float3)0;
    float tall = (float)0;

    const float _e6 = student_t_impl_max(v_4.z, 0.0);
    float3 above = float3(v_4.xy, _e6);
    w_5 = float3((sigma_3 * above.xy), above.z);
    float3 _e13 = w_5;
    float3 _e14 = w_5;
    const float _e15 = student_t_impl_dot(_e13, _e14);
    tall = sqrt(_e15);
    float _e18 = tall;
    if (!((_e18 >= 1e-6))) {
        float3 _e26 = w_5;
        float _e27 = tall;
        float _e32 = tall;
        w_5 = ((_e32 > 0.0) ? (_e26 / (max(_e27, 1e-37)).xxx) : float3(0.0, 0.0, 1.0));
        tall = 1.0;
    }
    const float _e38 = student_t_impl_unit(u_1.x);
    float _e43 = tall;
    float _e45 = w_5.z;
    float height = (max((1.0 - _e38), 5.9604645e-8) * (_e43 + _e45));
    float _e49 = w_5.z;
    float up_1 = (height - _e49);
    float _e51 = tall;
    float _e53 = tall;
    float radius = sqrt(max(((_e51 - up_1) * (_e53 + up_1)), 0.0));
    float3 _e59 = w_5;
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

StudentTImplHalfSlope student_t_impl_heavy_slope(StudentTLobe lobe_15, float number_1)
{
    const float _e4 = student_t_impl_log(max(number_1, 1e-37));
    float power = max((_e4 * lobe_15.heavy_exponent), -69.3);
    float zeta = exp(power);
    float large = max(zeta, 1e-15);
    const float _e14 = student_t_impl_exp_growth((2.0 * power));
    float x_13 = (0.5 * sqrt(max(-(_e14), 0.0)));
    float z = (large * lobe_15.heavy_root_s);
    const StudentTImplHalfSlope studenttimplhalfslope = ConstructStudentTImplHalfSlope(x_13, z, 1.0, (zeta / large), (x_13 + z));
    return studenttimplhalfslope;
}

StudentTImplHalfSlope student_t_impl_table_slope(StudentTLobe lobe_16, float along, float at_8, float silhouette)
{
    bool second_2 = (along > 0.5);
    const StudentTImplPlace _e7 = student_t_impl_place(at_8, lobe_16.rows);
    const float _e8 = student_t_impl_end(along);
    const StudentTImplPlace _e14 = student_t_impl_place((_e8 * lobe_16.along_scale), (lobe_16.numbers - 1.0));
    const float _e16 = student_t_impl_along_at(lobe_16, _e7, uint(second_2), _e14);
    float sign_ = (second_2 ? -1.0 : 1.0);
    float clear = (_e16 - (second_2 ? 0.0 : silhouette));
    const StudentTImplHalfSlope studenttimplhalfslope_1 = ConstructStudentTImplHalfSlope((_e16 - 1.0), (_e16 * (2.0 - _e16)), sign_, 1.0, clear);
    return studenttimplhalfslope_1;
}

float3 student_t_impl_sample_tables(StudentTLobe lobe_17, float3 v_5, float2 u_3)
{
    float rest = (float)0;
    float along_1 = (float)0;
    bool is_heavy = false;
    float number_2 = 1.0;
    StudentTImplHalfSlope slope = (StudentTImplHalfSlope)0;

    const float _e4 = student_t_impl_end(u_3.y);
    const StudentTImplPlace _e12 = student_t_impl_place((_e4 * lobe_17.across_scale), ((0.8408964 * lobe_17.across_scale) + 0.5));
    const float _e13 = student_t_impl_across_at(lobe_17, _e12);
    float t_2 = ((u_3.y > 0.5) ? (1.0 - _e13) : (_e13 - 1.0));
    float tz = (_e13 * (2.0 - _e13));
    const StudentTImplDirection _e26 = student_t_impl_stretch(lobe_17.sigma, v_5);
    float tall_2 = sqrt((_e26.square + (_e26.z * _e26.z)));
    rest = (1.0 - (_e26.z / (_e26.rho + tall_2)));
    if ((lobe_17.heavy_per_row > 0.0)) {
        float steep = (tall_2 + _e26.z);
        rest = ((_e26.rho * (steep + _e26.rho)) / (steep * (_e26.rho + tall_2)));
    }
    float _e53 = rest;
    const float _e54 = student_t_impl_unit(_e53);
    float at_12 = max(max((lobe_17.rows_first - (lobe_17.rows_first * _e54)), (lobe_17.rows_second_end - (lobe_17.rows_second * _e54))), (lobe_17.rows - (lobe_17.rows_third * _e54)));
    const float _e70 = student_t_impl_unit(u_3.x);
    along_1 = _e70;
    if ((lobe_17.heavy_per_row > 0.0)) {
        float cells = lobe_17.heavy_per_row;
        const StudentTImplPlace _e83 = student_t_impl_place((at_12 * cells), (lobe_17.rows * cells));
        const float2 _e84 = student_t_impl_share_at(lobe_17, _e83);
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
        const StudentTImplHalfSlope _e102 = student_t_impl_heavy_slope(lobe_17, _e101);
        slope = _e102;
    } else {
        float _e103 = along_1;
        const StudentTImplHalfSlope _e104 = student_t_impl_table_slope(lobe_17, _e103, at_12, _e54);
        slope = _e104;
    }
    float _e106 = slope.z;
    float _e108 = slope.z;
    float _e114 = slope.x;
    float _e116 = slope.x;
    float norm = sqrt(((_e106 * _e108) + ((4.0 * lobe_17.s) * (_e114 * _e116))));
    float _e122 = slope.x;
    float _e124 = slope.sign_;
    float ahead = (_e122 * (_e124 * tz));
    float aside = (norm * t_2);
    float2 turned = float2(((ahead * _e26.xy.x) - (aside * _e26.xy.y)), ((ahead * _e26.xy.y) + (aside * _e26.xy.x)));
    float _e146 = slope.z;
    float _e154 = slope.shrink;
    const float3 _e155 = student_t_impl_raise(float3((lobe_17.sigma * turned), (_e146 * (0.5 * (_e26.frame * tz)))), _e154);
    float _e157 = slope.clear;
    if (!(((_e157 * tz) >= ((1e-5 * tz) + (2e-5 * abs(t_2)))))) {
        const float3 _e170 = student_t_impl_face(float3(v_5.xy, _e26.z), _e155);
        return _e170;
    }
    return _e155;
}

float3 student_t_lobe_sample_visible_normal(StudentTLobe lobe_18, float3 v_6, float2 u_4)
{
    if ((lobe_18.is_ggx > 0.0)) {
        const float3 _e7 = student_t_impl_sample_cap(lobe_18.sigma, v_6, u_4);
        return _e7;
    }
    const float3 _e8 = student_t_impl_sample_tables(lobe_18, v_6, u_4);
    return _e8;
}

float student_t_lobe_visible_normal_pdf(StudentTLobe lobe_19, float3 v_7, float3 m_4)
{
    const float _e3 = student_t_impl_dot(v_7, m_4);
    const float _e5 = student_t_impl_max(_e3, 0.0);
    const float _e6 = student_t_lobe_d(lobe_19, m_4);
    float density_1 = (_e5 * _e6);
    const StudentTImplDirection _e9 = student_t_impl_stretch(lobe_19.sigma, v_7);
    const float _e10 = student_t_impl_inverse_area(lobe_19, _e9);
    const float _e11 = student_t_impl_product(density_1, _e10);
    return _e11;
}

float3 student_t_reflect(float3 v_8, float3 m_5)
{
    const float _e2 = student_t_impl_dot(v_8, m_5);
    return (((2.0 * _e2) * m_5) - v_8);
}

float student_t_lobe_reflection_pdf(StudentTLobe lobe_20, float3 v_9, float3 m_6)
{
    const float _e3 = student_t_impl_dot(v_9, m_6);
    if (!((_e3 > 0.0))) {
        return 0.0;
    }
    const float _e8 = student_t_lobe_d(lobe_20, m_6);
    float density_2 = (0.25 * _e8);
    const StudentTImplDirection _e12 = student_t_impl_stretch(lobe_20.sigma, v_9);
    const float _e13 = student_t_impl_inverse_area(lobe_20, _e12);
    const float _e14 = student_t_impl_product(density_2, _e13);
    return _e14;
}

float student_t_impl_tail(float gamma_1)
{
    const float _e2 = student_t_impl_max(gamma_1, 1.501);
    const float _e4 = student_t_impl_min(_e2, 1000000000000.0);
    return (1.0 / (_e4 - 1.0));
}

float student_t_impl_facing_pdf(float slope2_, float sigma_4, float s)
{
    float x_14 = ((slope2_ / sigma_4) / sigma_4);
    const float _e11 = student_t_impl_log_growth((s * x_14));
    float power_1 = exp((-((1.0 + (1.0 / s))) * _e11));
    float scale_1 = ((1.0 + slope2_) / sigma_4);
    const float _e18 = student_t_impl_product((power_1 * scale_1), scale_1);
    const float _e20 = student_t_impl_product(_e18, 0.07957747);
    return _e20;
}

float4 student_t_prefilter_light(float2 u_5, float sigma_5, float gamma_2)
{
    const float _e3 = student_t_impl_tail(gamma_2);
    const float _e4 = student_t_impl_sigma(sigma_5);
    const float _e6 = student_t_impl_unit(u_5.x);
    const float _e8 = student_t_impl_min(_e6, 0.99999994);
    const float _e11 = student_t_impl_log_growth(-(_e8));
    const float _e13 = student_t_impl_exp_growth((-(_e3) * _e11));
    float slope_2 = (_e4 * sqrt((_e13 / _e3)));
    float slope_2_ = (slope_2 * slope_2);
    float secant_2_ = (1.0 + slope_2_);
    float sine_1 = ((2.0 * slope_2) / secant_2_);
    const float _e24 = student_t_impl_unit(u_5.y);
    const float2 _e25 = student_t_impl_turn(_e24);
    const float _e26 = student_t_impl_facing_pdf(slope_2_, _e4, _e3);
    return float4((sine_1 * _e25), ((1.0 - slope_2_) / secant_2_), _e26);
}

float student_t_prefilter_pdf(float cos_theta_2, float sigma_6, float gamma_3)
{
    const float _e3 = student_t_impl_unit(cos_theta_2);
    if (!((cos_theta_2 > 0.0))) {
        return 0.0;
    }
    const float _e8 = student_t_impl_tail(gamma_3);
    const float _e14 = student_t_impl_sigma(sigma_6);
    const float _e15 = student_t_impl_facing_pdf(((1.0 - _e3) / (1.0 + _e3)), _e14, _e8);
    return _e15;
}

float3 student_t_impl_limit(float3 moments)
{
    const float _e3 = student_t_impl_max(moments.y, 0.0);
    const float _e5 = student_t_impl_min(_e3, moments.x);
    const float _e9 = student_t_impl_unit(moments.z);
    return float3((moments.x - _e5), _e5, _e9);
}

float student_t_lobe_albedo(StudentTLobe lobe_21, float cos_theta_3, uint masking_7)
{
    const StudentTImplAlbedo _e3 = student_t_impl_albedo_of(lobe_21, masking_7);
    const float _e4 = student_t_impl_lost(_e3, cos_theta_3, masking_7);
    return (1.0 - _e4);
}

float3 student_t_lobe_albedo_parts(StudentTLobe lobe_22, float cos_theta_4, uint masking_8)
{
    const StudentTImplAlbedo _e3 = student_t_impl_albedo_of(lobe_22, masking_8);
    const float3 _e4 = student_t_impl_moments(_e3, cos_theta_4, masking_8);
    const float3 _e10 = student_t_impl_limit(float3((1.0 + _e4.x), _e4.yz));
    return _e10;
}

float student_t_lobe_albedo_average(StudentTLobe lobe_23, uint masking_9)
{
    const StudentTImplAlbedo _e2 = student_t_impl_albedo_of(lobe_23, masking_9);
    const float3 _e3 = student_t_impl_averages(_e2);
    return (1.0 - _e3.x);
}

float3 student_t_lobe_albedo_average_parts(StudentTLobe lobe_24, uint masking_10)
{
    const StudentTImplAlbedo _e2 = student_t_impl_albedo_of(lobe_24, masking_10);
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

float student_t_lobe_compensation(StudentTLobe lobe_25, float3 v_10, float3 l_3, uint masking_11)
{
    bool local_10 = (bool)0;

    if ((v_10.z > 0.0)) {
        local_10 = (l_3.z > 0.0);
    } else {
        local_10 = false;
    }
    bool _e13 = local_10;
    if (!(_e13)) {
        return 0.0;
    }
    const StudentTImplAlbedo _e16 = student_t_impl_albedo_of(lobe_25, masking_11);
    const float _e18 = student_t_impl_lost(_e16, v_10.z, masking_11);
    const float _e20 = student_t_impl_lost(_e16, l_3.z, masking_11);
    const float3 _e21 = student_t_impl_averages(_e16);
    const float _e23 = student_t_impl_kulla_conty(_e18, _e20, _e21.x);
    return _e23;
}

float student_t_compensation_from(float e_v, float e_l, float e_average)
{
    const float _e9 = student_t_impl_kulla_conty((1.0 - e_v), (1.0 - e_l), (1.0 - e_average));
    return _e9;
}

#endif
