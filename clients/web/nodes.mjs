// Exported WGSL as nodes of three.js: wgslFn takes one function, so that each is a line that calls
// one of a module, which is included as it was exported.

import { wgsl, wgslFn } from 'three/tsl';

/// The functions without tables.
export function closedNodes(text) {
    const module = wgsl(text);
    return {
        d: wgslFn(`fn closed_d(gamma: f32, sigma: vec2f, m: vec3f) -> f32 {
            return student_t_closed_d(gamma, sigma, m);
        }`, [module]),
        masking: wgslFn(`fn closed_masking(gamma: f32, sigma: vec2f, w: vec3f) -> f32 {
            return student_t_closed_masking(gamma, sigma, w);
        }`, [module]),
        albedo: wgslFn(`fn closed_albedo(gamma: f32, sigma: f32, cos_theta: f32) -> f32 {
            return student_t_closed_albedo(gamma, sigma, cos_theta);
        }`, [module]),
    };
}

/// Lobes by tables, which are an argument: a module of `--argument`. It is one node, since each
/// includes its text once more.
export function lobeNodes(text, isFamily) {
    const module = wgsl(text);
    const made = isFamily
        ? `fn lobe_at(gamma: f32, sigma: vec2f, tables: texture_2d<u32>) -> StudentTLobe {
            return student_t_lobe_at(gamma, sigma, tables);
        }`
        : `fn lobe_of(shape: u32, sigma: vec2f, tables: texture_2d<f32>) -> StudentTLobe {
            return student_t_lobe_of(shape, sigma, tables);
        }`;
    const tables = `tables: texture_2d<${isFamily ? 'u32' : 'f32'}>`;
    const masking = 'STUDENT_T_HEIGHT_CORRELATED';
    return {
        lobe: wgslFn(made, [module]),
        d: wgslFn(`fn lobe_d(lobe: StudentTLobe, m: vec3f) -> f32 {
            return student_t_lobe_d(lobe, m);
        }`, [module]),
        masking: wgslFn(`fn lobe_masking(lobe: StudentTLobe, w: vec3f, ${tables}) -> f32 {
            return student_t_lobe_masking(lobe, w, tables);
        }`, [module]),
        albedo: wgslFn(`fn lobe_albedo(lobe: StudentTLobe, cos_theta: f32, ${tables}) -> f32 {
            return student_t_lobe_albedo(lobe, cos_theta, ${masking}, tables);
        }`, [module]),
        evalPdf: wgslFn(
            `fn lobe_eval_pdf(lobe: StudentTLobe, v: vec3f, l: vec3f, ${tables}) -> vec2f {
            return student_t_lobe_eval_pdf(lobe, v, l, ${masking}, tables);
        }`, [module]),
    };
}
