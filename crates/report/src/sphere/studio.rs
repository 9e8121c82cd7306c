//! The studio that a sphere is shown in: its lamps, its backdrop and its camera.
//!
//! World coordinates are right-handed, y up, z towards the camera; the sphere has radius 1 about
//! the origin and lies on a floor. Light depends on the direction alone, except that of the floor.
//! `studio.glsl` has the same functions; their constants are written from here.

use std::f32::consts::{FRAC_1_PI, PI};

use glam::{Vec2, Vec3};

use microfacet_export::numbers::single;

/// A softbox at infinity: a rectangle on the plane at distance 1 across its direction.
pub(super) struct Lamp {
    /// Unit vector; `across` and `up`, also of unit length, span the rectangle.
    towards: Vec3,
    across: Vec3,
    up: Vec3,
    half: Vec2,
    /// The width of the soft edge, within the rectangle.
    soft: f32,
    radiance: Vec3,
}

/// A key light upper left, a strip to the right, a rim light behind.
fn lamps() -> [Lamp; 3] {
    let lamp = |towards: [f32; 3], half: [f32; 2], soft, radiance: [f32; 3]| {
        let towards = Vec3::from(towards).normalize();
        let across = Vec3::Y.cross(towards).normalize();
        let (half, radiance) = (Vec2::from(half), Vec3::from(radiance));
        Lamp { towards, across, up: towards.cross(across), half, soft, radiance }
    };
    [
        lamp([-0.72, 0.78, 0.62], [0.46, 0.46], 0.2, [7.2, 6.9, 6.4]),
        lamp([0.97, 0.16, 0.3], [0.1, 0.8], 0.08, [4.4, 4.4, 4.4]),
        lamp([0.6, 0.52, -0.72], [0.26, 0.42], 0.14, [3.0, 3.2, 3.6]),
    ]
}

/// Radiance of the dome at the zenith and the horizon, and of the backdrop about a direction.
const ZENITH: Vec3 = Vec3::new(0.22, 0.217, 0.215);
const HORIZON: Vec3 = Vec3::new(0.055, 0.053, 0.052);
const GLOW: Vec3 = Vec3::new(0.27, 0.262, 0.256);
const GLOW_TOWARDS: Vec3 = Vec3::new(0.0, 0.0, -1.0);
/// Radiance of the floor under the dome alone, and under the key light.
const FLOOR_DOME: Vec3 = Vec3::new(0.09, 0.088, 0.086);
const FLOOR_KEY: Vec3 = Vec3::new(0.26, 0.253, 0.245);
/// The distances from the sphere between which the floor passes into the backdrop.
const FLOOR_ENDS: [f32; 2] = [1.5, 9.0];
/// The tangent of the key light's radius, for its shadow.
const PENUMBRA: f32 = 0.5;

/// The position of the camera, the point that it looks at, and the tangent of half its field.
const EYE: Vec3 = Vec3::new(0.0, 1.35, 6.2);
const LOOKS_AT: Vec3 = Vec3::new(0.0, -0.1, 0.0);
const TANGENT: f32 = 0.222;

pub(super) struct Studio {
    lamps: [Lamp; 3],
    /// The camera's axes: right, up, and towards it.
    camera: [Vec3; 3],
}

/// The cubic from 0 to 1, as of GLSL.
fn smoothstep(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

impl Lamp {
    /// The point on the lamp in a direction, in halves of its edges, and the cosine; else `None`.
    fn place(&self, d: Vec3) -> Option<(Vec2, f32)> {
        let z = d.dot(self.towards);
        if !(z > 1e-3) {
            return None;
        }
        let p = Vec2::new(d.dot(self.across), d.dot(self.up)) / (z * self.half);
        (p.abs().max_element() < 1.0).then_some((p, z))
    }

    fn radiance(&self, p: Vec2) -> Vec3 {
        let edge = (1.0 - p.abs()) * self.half;
        let x = smoothstep(0.0, self.soft, edge.x) * smoothstep(0.0, self.soft, edge.y);
        self.radiance * (x * (1.0 - 0.25 * p.dot(p)))
    }

    /// The density per steradian of directions towards the lamp, at a cosine.
    fn pdf(&self, z: f32) -> f32 {
        1.0 / (4.0 * self.half.x * self.half.y * z * z * z)
    }
}

impl Studio {
    pub(super) fn new() -> Self {
        let back = (EYE - LOOKS_AT).normalize();
        let right = Vec3::Y.cross(back).normalize();
        Self { lamps: lamps(), camera: [right, back.cross(right), back] }
    }

    /// A ray through a point of the picture, in [−1, 1].
    pub(super) fn ray(&self, x: f32, y: f32) -> (Vec3, Vec3) {
        let [right, up, back] = self.camera;
        (EYE, (right * (x * TANGENT) + up * (y * TANGENT) - back).normalize())
    }

    /// The light that arrives at a point from a direction; the camera sees no lamps.
    pub(super) fn radiance(&self, from: Vec3, d: Vec3, with_lamps: bool) -> Vec3 {
        let mut sum = self.dome(d);
        if d.y < 0.0 {
            let t = (from.y + 1.0) / -d.y;
            let (floor, share) = self.floor(from + t.max(0.0) * d);
            sum += (floor - sum) * share;
        }
        if with_lamps && d.y > -0.2 {
            for lamp in &self.lamps {
                if let Some((p, _)) = lamp.place(d) {
                    sum += lamp.radiance(p);
                }
            }
        }
        sum
    }

    fn dome(&self, d: Vec3) -> Vec3 {
        let up = d.y.max(0.0);
        let facing = d.dot(GLOW_TOWARDS).max(0.0);
        let square = facing * facing;
        HORIZON + (ZENITH - HORIZON) * (up * up) + GLOW * (square * square * square)
    }

    /// The radiance of a point of the floor, and the share of the floor; the rest is backdrop.
    fn floor(&self, q: Vec3) -> (Vec3, f32) {
        // The sphere, which touches the floor, hides (R/distance)² cos of the dome.
        let square = q.x * q.x + q.z * q.z;
        let distance = (square + 1.0).sqrt();
        let dome = 1.0 - 1.0 / (distance * distance * distance);
        // How far the key light's middle passes by the sphere, in radii of its penumbra.
        let towards = self.lamps[0].towards;
        let along = -q.dot(towards);
        let passes = (q.dot(q) - along * along).max(0.0).sqrt() - 1.0;
        let key = smoothstep(-PENUMBRA, PENUMBRA, passes / along.max(0.2));
        let share = 1.0 - smoothstep(FLOOR_ENDS[0], FLOOR_ENDS[1], square.sqrt());
        (FLOOR_DOME * dome + FLOOR_KEY * (key * (0.35 + 0.65 * dome)), share)
    }

    /// A direction towards each of the lamps, from two numbers in [0, 1).
    pub(super) fn sample(&self, [a, b]: [f32; 2]) -> [Vec3; 3] {
        let p = 2.0 * Vec2::new(a, b) - 1.0;
        self.lamps.each_ref().map(|Lamp { towards, across, up, half, .. }| {
            (towards + p.x * half.x * across + p.y * half.y * up).normalize()
        })
    }

    /// The sum of the densities per steradian of the directions of [`sample`](Self::sample).
    pub(super) fn pdf(&self, d: Vec3) -> f32 {
        let of = |lamp: &Lamp| lamp.place(d).map_or(0.0, |(_, z)| lamp.pdf(z));
        self.lamps.iter().map(of).sum()
    }
}

/// A direction about z with a density proportional to the cosine, from two numbers in [0, 1).
pub(super) fn by_cosine([a, b]: [f32; 2]) -> Vec3 {
    let (sin, cos) = (2.0 * PI * b).sin_cos();
    let (r, z) = (a.sqrt(), (1.0 - a).sqrt());
    Vec3::new(r * cos, r * sin, z)
}

/// The density per steradian of [`by_cosine`].
pub(super) fn cosine_pdf(l: Vec3) -> f32 {
    l.z * FRAC_1_PI
}

pub(super) fn constants() -> String {
    let numbers = |x: &[f32]| x.iter().map(|x| single(*x)).collect::<Vec<_>>().join(", ");
    let vec3 = |v: Vec3| format!("vec3({})", numbers(&v.to_array()));
    let vec2 = |v: Vec2| format!("vec2({})", numbers(&v.to_array()));
    let studio = Studio::new();
    let lamp = |Lamp { towards, across, up, half, soft, radiance }: &Lamp| {
        let directions = [towards, across, up].map(|v| vec3(*v)).join(", ");
        let (half, soft, radiance) = (vec2(*half), single(*soft), vec3(*radiance));
        format!("    Lamp({directions},\n         {half}, {soft}, {radiance})")
    };
    let (count, lamps) = (studio.lamps.len(), studio.lamps.each_ref().map(lamp).join(",\n"));
    let [right, up, back] = studio.camera.map(vec3);
    let constants = [
        ("vec3", "ZENITH", vec3(ZENITH)),
        ("vec3", "HORIZON", vec3(HORIZON)),
        ("vec3", "GLOW", vec3(GLOW)),
        ("vec3", "GLOW_TOWARDS", vec3(GLOW_TOWARDS)),
        ("vec3", "FLOOR_DOME", vec3(FLOOR_DOME)),
        ("vec3", "FLOOR_KEY", vec3(FLOOR_KEY)),
        ("vec3", "EYE", vec3(EYE)),
        ("vec3", "CAMERA_RIGHT", right),
        ("vec3", "CAMERA_UP", up),
        ("vec3", "CAMERA_BACK", back),
        ("vec2", "FLOOR_ENDS", vec2(FLOOR_ENDS.into())),
        ("float", "PENUMBRA", single(PENUMBRA)),
        ("float", "TANGENT", single(TANGENT)),
    ];
    let constant =
        |(kind, name, value): &(&str, &str, String)| format!("const {kind} {name} = {value};\n");
    format!(
        "struct Lamp {{ vec3 towards; vec3 across; vec3 up; vec2 half_size; float soft; \
         vec3 radiance; }};\n\
         const Lamp LAMPS[{count}] = Lamp[{count}](\n{lamps});\n{}",
        constants.iter().map(constant).collect::<String>()
    )
}
