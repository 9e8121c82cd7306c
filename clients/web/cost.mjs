// What functions of shaders cost, counted in SPIR-V as glslang compiles and spirv-opt -O optimises
// it: those of the kit for real time and of a family, and GGX as three.js has it.
//
//     node clients/web/cost.mjs FOLDER
//
// prints the table of docs/shaders.md. FOLDER has the exports `glsl --realtime` and
// `glsl --family --textures` as realtime and family.
import { execFileSync } from 'node:child_process';
import fs from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import common from 'three/src/renderers/shaders/ShaderChunk/common.glsl.js';
import lights from 'three/src/renderers/shaders/ShaderChunk/lights_physical_pars_fragment.glsl.js';

/** The text of a function of three.js. */
const taken = (chunk, start) => {
    const at = chunk.indexOf(start);
    if (at < 0) throw new Error(`three.js has no ${start}`);
    const from = chunk.slice(at);
    return from.slice(0, from.search(/\n\t?}/) + 3);
};

/** GGX of three.js: D, visibility and Schlick's reflectance, round and anisotropic. */
const ggx = [
    '#define RECIPROCAL_PI 0.3183098861837907\n#define EPSILON 1e-6',
    'float pow2( const in float x ) { return x*x; }',
    '#define saturate( a ) clamp( a, 0.0, 1.0 )',
    taken(common, 'vec3 F_Schlick('),
    taken(lights, 'float V_GGX_SmithCorrelated('),
    taken(lights, 'float D_GGX('),
    taken(lights, 'float V_GGX_SmithCorrelated_Anisotropic('),
    taken(lights, 'float D_GGX_Anisotropic('),
].join('\n');

const surface = `StudentTSurface s = StudentTSurface(x[0].xy, x[0].z, x[0].w, x[1].x, x[1].y,
    x[1].z, x[2].xy);
    vec3 v = x[3].xyz, l = x[4].xyz, m = x[5].xyz, f0 = x[6].xyz;`;
const area = (w) => `student_t_surface_area(s, ${w},
    textureLod(masking, student_t_surface_masking_at(s, ${w}), 0.0).x)`;
const albedo = (z) => `textureLod(albedo, student_t_surface_albedo_at(s, ${z}), 0.0)`;
const lobe = 'StudentTLobe lobe = student_t_lobe_at(x[0].x, x[0].yz);\n';
const directions = 'vec3 v = x[3].xyz, l = x[4].xyz, m = x[5].xyz;\n';

/** Rows: what is counted, in which text, and the program. What a lobe of a family takes is
 * counted once and taken off the others. */
const rows = [
    ['GGX of three.js: D', ggx, 'y[0].x = D_GGX(x[0].x, x[1].x);'],
    ['visibility, round', ggx, 'y[0].x = V_GGX_SmithCorrelated(x[0].x, x[1].x, x[1].y);'],
    ['a light, round', ggx, `vec3 v = x[3].xyz, l = x[4].xyz, h = normalize(l + v);
    float a = pow2(max(x[0].x, 0.045)), nl = saturate(l.z), nv = saturate(v.z);
    float nh = saturate(h.z), vh = saturate(dot(v, h));
    float vis = V_GGX_SmithCorrelated(a, nl, nv);
    y[0].xyz = F_Schlick(x[6].xyz, 1.0, vh) * (vis * D_GGX(a, nh)) * nl;`],
    ['a light, anisotropic', ggx, `vec3 v = x[3].xyz, l = x[4].xyz, h = normalize(l + v);
    float a = pow2(max(x[0].x, 0.045)), nl = saturate(l.z), nv = saturate(v.z);
    float nh = saturate(h.z), vh = saturate(dot(v, h)), t = max(x[0].y, a);
    float vis = V_GGX_SmithCorrelated_Anisotropic(t, a, v.x, v.y, l.x, l.y, nv, nl);
    y[0].xyz = F_Schlick(x[6].xyz, 1.0, vh) * (vis * D_GGX_Anisotropic(t, a, nh, h.x, h.y)) * nl;`],
    ['Real time: `student_t_surface`', 'realtime', `StudentTSurface s =
    student_t_surface(x[0].x, x[0].yz); y[0] = vec4(s.sigma, s.s, s.power);
    y[1] = vec4(s.peak, s.kappa, s.stretch, 0.0); y[2].xy = s.rows;`],
    ['`student_t_surface_d`', 'realtime', `${surface} y[0].x = student_t_surface_d(s, m);`],
    ['`student_t_surface_area`, with its fetch', 'realtime', `${surface} y[0].x = ${area('v')};`],
    ['`student_t_surface_albedo_at`, with its fetch', 'realtime',
        `${surface} y[0] = ${albedo('v.z')};`],
    ['a view: its area and its albedos', 'realtime',
        `${surface} y[0].x = ${area('v')}; y[1] = ${albedo('v.z')};`],
    ['a light: one bounce', 'realtime', `${surface} m = normalize(v + l);
    y[0].xyz = student_t_schlick(f0, 1.0, dot(v, m))
        * student_t_surface_eval(s, v, l, m, x[7].x, ${area('l')});`],
    ['the same, a tinted metal', 'realtime', `${surface} m = normalize(v + l);
    y[0].xyz = student_t_f82_tint(f0, x[8].xyz, dot(v, m))
        * student_t_surface_eval(s, v, l, m, x[7].x, ${area('l')});`],
    ['the same, times `student_t_scaled_bounce`', 'realtime', `${surface} m = normalize(v + l);
    y[0].xyz = student_t_schlick(f0, 1.0, dot(v, m)) * student_t_scaled_bounce(x[9], f0)
        * student_t_surface_eval(s, v, l, m, x[7].x, ${area('l')});`],
    ['a light: further bounces', 'realtime', `${surface}
    y[0].xyz = l.z * student_t_further_bounces(x[9], ${albedo('l.z')}.x, x[8].xyz);`],
    ['a light: all bounces', 'realtime', `${surface} m = normalize(v + l);
    y[0].xyz = student_t_schlick(f0, 1.0, dot(v, m))
        * student_t_surface_eval(s, v, l, m, x[7].x, ${area('l')})
        + l.z * student_t_further_bounces(x[9], ${albedo('l.z')}.x, x[8].xyz);`],
    ['Family: `student_t_lobe_at`, and D', 'family',
        `${lobe}${directions}y[0].x = student_t_lobe_d(lobe, m);`],
    ['the same, and `…_masking`', 'family',
        `${lobe}${directions}y[0].x = student_t_lobe_masking(lobe, v);`],
    ['the same, and `…_eval_pdf`', 'family',
        `${lobe}${directions}y[0].xy = student_t_lobe_eval_pdf(lobe, v, l, 1u);`],
    ['the same, and `…_sample_visible_normal`', 'family', `${lobe}${directions}
    y[0].xyz = student_t_lobe_sample_visible_normal(lobe, v, x[7].xy);`],
    ['the same, and `…_albedo`', 'family',
        `${lobe}${directions}y[0].x = student_t_lobe_albedo(lobe, v.z, 1u);`],
    ['the same, and `…_compensation`', 'family',
        `${lobe}${directions}y[0].x = student_t_lobe_compensation(lobe, v, l, 1u);`],
];

/** Operations of one component that an instruction stands for, n its components: additions,
 * products, comparisons and the like, and those that devices compute more slowly. */
const plain = new RegExp('^Op(F(Add|Sub|Mul|Negate|Ord.*|Unord.*)|I(Add|Sub|Mul|Equal|NotEqual)'
    + '|[SU](Less|Greater).*|Select|Logical.*|Shift.*|Bitwise.*|Not|Convert.*|VectorTimesScalar)$');
const extended = {
    FAbs: [1, 0], FMin: [1, 0], FMax: [1, 0], UMin: [1, 0], UMax: [1, 0], SMin: [1, 0],
    SMax: [1, 0], FClamp: [2, 0], UClamp: [2, 0], SClamp: [2, 0],
    Floor: [1, 0], Fract: [1, 0], FMix: [3, 0], Fma: [1, 0], FSign: [1, 0],
    Sqrt: [0, 1], InverseSqrt: [0, 1], Exp: [1, 1], Exp2: [0, 1], Log: [1, 1], Log2: [0, 1],
    Pow: [1, 2], Sin: [0, 1], Cos: [0, 1],
};

/** Counts of a program in SPIR-V's text. */
function counted(text) {
    const count = { plain: 0, slow: 0, fetches: 0, branches: 0, loops: 0 };
    // Operands have names of types: the number of components of each value.
    const components = (type) => Number(/^%v(\d)/.exec(type)?.[1] ?? 1);
    const types = new Map();
    for (const line of text.split('\n')) {
        const [, id, op, rest] = /^\s*(?:(%\S+) = )?(Op\w+)\s*(.*)$/.exec(line) ?? [];
        if (!op) continue;
        const [type, ...operands] = (rest ?? '').split(' ');
        if (id) types.set(id, type);
        const n = components(type);
        const add = ([a, b], times = n) => {
            count.plain += a * times;
            count.slow += b * times;
        };
        if (op === 'OpExtInst') {
            const [, name, first] = operands;
            const width = components(types.get(first));
            if (name === 'Length') add([2 * width - 1, 1], 1);
            else if (name === 'Normalize') add([3 * width - 1, 1], 1);
            else if (extended[name]) add(extended[name]);
            else throw new Error(`no count of ${name}`);
        } else if (op === 'OpDot') add([2 * components(types.get(operands[0])) - 1, 0], 1);
        else if (/^Op(FDiv|FMod|FRem|[SU]Div|[SU]Mod)$/.test(op)) add([0, 1]);
        else if (plain.test(op)) add([1, 0]);
        else if (/^OpImage(Sample|Fetch|Read)/.test(op)) count.fetches += 1;
        else if (op === 'OpBranchConditional' || op === 'OpSwitch') count.branches += 1;
        else if (op === 'OpLoopMerge') count.loops += 1;
    }
    return count;
}

/** The rows of the table, from a folder with exports. */
export function table(folder) {
    const scratch = fs.mkdtempSync(path.join(os.tmpdir(), 'cost-'));
    const read = (...names) => fs.readFileSync(path.join(folder, ...names), 'utf8');
    const texts = {
        realtime: `layout(set = 1, binding = 2) uniform sampler2D masking;
layout(set = 1, binding = 3) uniform sampler3D albedo;\n`
            + read('realtime', 'student_t_realtime.glsl'),
        family: read('family', 'student_t_family.glsl'),
    };
    const lines = rows.map(([name, text, body]) => {
        const source = path.join(scratch, 'cost.comp');
        const [raw, optimised] = ['raw.spv', 'cost.spv'].map((file) => path.join(scratch, file));
        fs.writeFileSync(source, `#version 450
layout(local_size_x = 1) in;
layout(set = 1, binding = 0) readonly buffer In { vec4 x[]; };
layout(set = 1, binding = 1) writeonly buffer Out { vec4 y[]; };
${texts[text] ?? text}
void main() {\n    ${body}\n}\n`);
        const to = ['--quiet', '-V', '--target-env', 'vulkan1.1', source, '-o', raw];
        execFileSync('glslangValidator', to, { stdio: 'inherit' });
        execFileSync('spirv-opt', ['-O', raw, '-o', optimised]);
        const listing = execFileSync('spirv-dis', ['--no-color', optimised], { encoding: 'utf8' });
        const { plain: all, slow, fetches, branches, loops } = counted(listing);
        return `| ${name} | ${all} | ${slow} | ${fetches} | ${branches} | ${loops} |`;
    });
    fs.rmSync(scratch, { recursive: true });
    return lines;
}

if (process.argv[1] === fileURLToPath(import.meta.url)) {
    for (const line of table(process.argv[2])) console.log(line);
}
