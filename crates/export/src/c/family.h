
/* ---- Families: tables of every gamma --------------------------------------------------------- */

/* What "StuT" is in the bytes of a little-endian machine, the only ones that read these files. */
#define STUDENT_T_FAMILY_MAGIC 0x54757453u

/* The size of a family in bytes. A kernel of CUDA or HIP may take the address of a copy of so many
 * bytes, in managed or in device memory. */
STUDENT_T_FUNCTION unsigned student_t_family_bytes(const student_t_family *family)
{
    return family->bytes;
}

/* The family whose bytes are at an address, which is a multiple of 4, as read from a file that
 * `export c --family --binary` wrote; null if they are not those of a family of this header. */
STUDENT_T_FUNCTION const student_t_family *student_t_family_in(const void *bytes, unsigned count)
{
    const student_t_family *family = STUDENT_T_IMPL_CAST(const student_t_family *, bytes);
    const int is_one = count >= sizeof(student_t_family) &&
                       family->magic == STUDENT_T_FAMILY_MAGIC &&
                       family->layout == STUDENT_T_LAYOUT && family->bytes <= count;
    return is_one ? family : STUDENT_T_IMPL_NULL;
}

/* A table of a family. */
STUDENT_T_FUNCTION const void *student_t_impl_at(const student_t_family *family, unsigned offset)
{
    const void *start = family;
    return STUDENT_T_IMPL_CAST(const char *, start) + offset;
}

STUDENT_T_FUNCTION const float *
student_t_impl_floats(const student_t_family *family, unsigned offset)
{
    return STUDENT_T_IMPL_CAST(const float *, student_t_impl_at(family, offset));
}

STUDENT_T_FUNCTION const unsigned short *
student_t_impl_codes(const student_t_family *family, unsigned offset)
{
    return STUDENT_T_IMPL_CAST(const unsigned short *, student_t_impl_at(family, offset));
}

STUDENT_T_FUNCTION void student_t_impl_window_at(const student_t_impl_between *between, int table,
                                                 float x, student_t_impl_window *window)
{
    const float(*c)[4] = between->weights[table];
    int i;
    window->start = between->starts[table];
    for (i = 0; i < 4; ++i)
        window->weights[i] = (c[0][i] + x * c[1][i]) + (x * x) * (c[2][i] + x * c[3][i]);
}

/* Fills in the lobe of a family at a gamma and a roughness along x and along y. gamma is taken at
 * the nearer end of the family's, NaN at the smallest. */
STUDENT_T_FUNCTION void student_t_family_set_lobe(const student_t_family *family, float gamma,
                                                  float sigma_x, float sigma_y,
                                                  student_t_lobe *lobe)
{
    const student_t_part *part =
        &family->part[gamma >= family->seam || family->parts < 2 ? 0 : 1];
    const float most = student_t_impl_min(part->gamma_max, 1e18f); /* whose square is a number */
    const float g = student_t_impl_min(student_t_impl_max(gamma, part->gamma_min), most);
    const float less = g - 1.0f, twice = 2.0f * g - 3.0f;
    const float s = 1.0f / less, exponent = 1.0f / twice, r = twice * s;
    const student_t_impl_between *between =
        STUDENT_T_IMPL_CAST(const student_t_impl_between *, student_t_impl_at(family, part->cells));
    const float slot = student_t_impl_max((part->first - r) * part->scale, 0.0f);
    float x;
    between += slot < STUDENT_T_IMPL_CAST(float, part->slot_count)
                   ? student_t_impl_codes(family, part->slots)[STUDENT_T_IMPL_CAST(int, slot)]
                   : part->last;
    x = (between->from - r) * between->inverse;
    lobe->sigma_x = student_t_impl_sigma(sigma_x);
    lobe->gamma = g < 1e18f ? g : STUDENT_T_LARGEST;
    lobe->sigma_y = student_t_impl_sigma(sigma_y);
    lobe->is_mirror = !(sigma_x > 0.0f && sigma_y > 0.0f);
    lobe->is_ggx = 0;
    lobe->law.s = s;
    lobe->law.d_s = student_t_impl_max(s, 9.094947e-13f); /* 2^-40: Beckmann to rounding */
    lobe->law.d_power = 0.5f - 0.5f * student_t_impl_min(less, 1.0995116e12f);
    lobe->law.kappa = part->kappa * (less * exponent);
    lobe->law.heavy_exponent = exponent;
    lobe->law.heavy_root_s = sqrtf(s);
    lobe->constants = &part->constants;
    lobe->shape = STUDENT_T_IMPL_NULL;
    lobe->family = family;
    lobe->part = part;
    lobe->albedos = family;
    student_t_impl_window_at(between, 0, x, &lobe->slopes);
    student_t_impl_window_at(between, 1, x, &lobe->across);
    student_t_impl_window_at(between, 2, x, &lobe->masking);
}

/* The same by value, which compilers of C copy, in the time of a sample. */
STUDENT_T_FUNCTION student_t_lobe student_t_family_lobe(const student_t_family *family, float gamma,
                                                        float sigma_x, float sigma_y)
{
    student_t_lobe lobe;
    student_t_family_set_lobe(family, gamma, sigma_x, sigma_y, &lobe);
    return lobe;
}

/* The cubic through values and slopes at both ends of a cell. */
STUDENT_T_FUNCTION float student_t_impl_hermite(const float nodes[4], float w)
{
    const float b0 = 1.0f + w * (w * (w * 2.0f - 3.0f)), b1 = w * (1.0f + w * (w - 2.0f));
    const float b2 = w * (w * (3.0f - w * 2.0f)), b3 = w * (w * (w - 1.0f));
    return (nodes[0] * b0 + nodes[2] * b2) + (nodes[1] * b1 + nodes[3] * b3);
}

/* The sum of codes of four nodes of gamma, which are so many numbers apart. */
STUDENT_T_FUNCTION float
student_t_impl_sum(const unsigned short *codes, int stride, const float weights[4])
{
    return (weights[0] * STUDENT_T_IMPL_CAST(float, codes[0]) +
            weights[1] * STUDENT_T_IMPL_CAST(float, codes[stride])) +
           (weights[2] * STUDENT_T_IMPL_CAST(float, codes[2 * stride]) +
            weights[3] * STUDENT_T_IMPL_CAST(float, codes[3 * stride]));
}

/* So many numbers at a place of a table of codes and columns. */
STUDENT_T_FUNCTION void student_t_impl_decode(const student_t_lobe *lobe, const unsigned table[2],
                                              int shapes, int place, int count,
                                              const student_t_impl_window *window, float *numbers)
{
    const unsigned short *codes = student_t_impl_codes(lobe->family, table[0]) +
                                  (place * shapes + window->start) * count;
    const float *columns = student_t_impl_floats(lobe->family, table[1]) + 2 * place * count;
    const float *w = window->weights;
    const float all = (w[0] + w[1]) + (w[2] + w[3]); /* 1, but of weights with factors */
    int i;
    for (i = 0; i < count; ++i)
        numbers[i] = columns[2 * i] * all +
                     columns[2 * i + 1] * student_t_impl_sum(codes + i, count, w);
}

/* ---- What lookups read, of a shape or of a family -------------------------------------------- */

/* The cubic of a cell of a table of values and slopes of a family. */
STUDENT_T_FUNCTION float student_t_impl_cell_of(const student_t_lobe *lobe,
                                                const unsigned table[2], int shapes,
                                                const student_t_impl_window *window, int cell,
                                                float w)
{
    float nodes[4];
    student_t_impl_decode(lobe, table, shapes, cell, 2, window, nodes);
    student_t_impl_decode(lobe, table, shapes, cell + 1, 2, window, nodes + 2);
    return student_t_impl_hermite(nodes, w);
}

/* G1/coordinate/cells of masking. */
STUDENT_T_FUNCTION float student_t_impl_masking_at(const student_t_lobe *lobe, int cell, float w)
{
    if (!lobe->family) return student_t_impl_cubic(lobe->shape->masking + 4 * cell, w);
    return student_t_impl_cell_of(lobe, lobe->part->masking, lobe->part->shapes[2],
                                  &lobe->masking, cell, w);
}

/* g of the slope across. */
STUDENT_T_FUNCTION float student_t_impl_across_at(const student_t_lobe *lobe, int cell, float w)
{
    if (!lobe->family) return student_t_impl_cubic(lobe->shape->across + 4 * cell, w);
    return student_t_impl_cell_of(lobe, lobe->part->across, lobe->part->shapes[1], &lobe->across,
                                  cell, w);
}

/* Value and slope at a node of a row of slopes and at the next, of a family. */
STUDENT_T_FUNCTION void
student_t_impl_row(const student_t_lobe *lobe, int row, int column, float nodes[4])
{
    const student_t_part *part = lobe->part;
    const int numbers = 2 * lobe->constants->numbers, step = 2 * part->shapes[0];
    const unsigned short *codes = student_t_impl_codes(lobe->family, part->slopes) +
                                  (row * numbers + column) * step + 2 * lobe->slopes.start;
    const float *c = student_t_impl_floats(lobe->family, part->columns) +
                     5 * (row / STUDENT_T_IMPL_ROWS * (numbers + 1) + column);
    const float *w = lobe->slopes.weights;
    int i, j;
    for (i = 0; i < 2; ++i, codes += step, c += 5) {
        float squares = 0.0f;
        if (c[2] > 0.0f) {
            for (j = 0; j < 4; ++j) {
                const float code = STUDENT_T_IMPL_CAST(float, codes[2 * j]);
                squares += w[j] * code * code;
            }
        }
        nodes[2 * i] = c[0] + c[1] * student_t_impl_sum(codes, 2, w) + c[2] * squares;
        nodes[2 * i + 1] = c[3] + c[4] * student_t_impl_sum(codes + 1, 2, w);
    }
}

/* g of the slope in the plane, at a node of a row: linear between the views, a cubic through values
 * and slopes along the number. */
STUDENT_T_FUNCTION float student_t_impl_along_at(const student_t_lobe *lobe, int row, int half,
                                                 int cell, float between, float w)
{
    const int numbers = lobe->constants->numbers, column = half * numbers + cell;
    float nodes[4];
    int i;
    if (lobe->family) {
        /* No row follows the last. */
        const int next = STUDENT_T_IMPL_CAST(float, row) < lobe->constants->rows ? row + 1 : row;
        float high[4], most;
        student_t_impl_row(lobe, row, column, nodes);
        student_t_impl_row(lobe, next, column, high);
        for (i = 0; i < 4; ++i) nodes[i] += between * (high[i] - nodes[i]);
        /* Weights below 0 may take slopes out of the range in which the cubic ascends. */
        most = student_t_impl_max(3.0f * (nodes[2] - nodes[0]), 0.0f);
        nodes[1] = student_t_impl_min(student_t_impl_max(nodes[1], 0.0f), most);
        nodes[3] = student_t_impl_min(student_t_impl_max(nodes[3], 0.0f), most);
        nodes[0] = student_t_impl_max(nodes[0], 0.0f);
        nodes[2] = student_t_impl_max(nodes[2], 0.0f);
    } else {
        const float *low = lobe->shape->slopes + 2 * (2 * row * numbers + column);
        const float *high = low + 4 * numbers;
        for (i = 0; i < 4; ++i) nodes[i] = low[i] + between * (high[i] - low[i]);
    }
    return student_t_impl_hermite(nodes, w);
}

/* The share of visible normals that is in no table, at a view's place among the rows of slopes, and
 * the rest. */
STUDENT_T_FUNCTION float student_t_impl_share_at(const student_t_lobe *lobe, float at, float *rest)
{
    float w, share;
    const int cell = student_t_impl_cell(at * lobe->constants->heavy_per_row, &w);
    if (lobe->family) {
        const student_t_part *part = lobe->part;
        const float *factors =
            student_t_impl_floats(lobe->family, part->rests[2]) + lobe->masking.start;
        student_t_impl_window window = lobe->masking;
        float c[4], heavy, whole;
        int i;
        for (i = 0; i < 4; ++i) window.weights[i] *= factors[i];
        student_t_impl_decode(lobe, part->rests, part->shapes[2], cell, 4, &window, c);
        *rest = student_t_impl_max(student_t_impl_cubic(c, w), STUDENT_T_SMALLEST);
        heavy = student_t_impl_cubic(
            student_t_impl_floats(lobe->family, part->rhos) + 4 * cell, w);
        heavy = student_t_impl_max(heavy, 0.0f);
        whole = 1.0f / (heavy + *rest);
        *rest *= whole;
        return heavy * whole;
    }
    share = student_t_impl_cubic(lobe->shape->heavy + 4 * cell, w);
    *rest = 1.0f - share;
    return share;
}
