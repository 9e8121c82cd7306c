// ---- Without tables -----------------------------------------------------------------------------
// The Student-t lobe of any shape gamma and roughness sigma without tables: D in closed form, and
// masking and the albedo by fitted forms. Their errors are in docs/shaders.md, "Without tables";
// their numbers come from the study `closed_forms`, which checks that they are these.
//
// gamma >= 1.501 (1.6 of the albedo), infinity or any large number for Beckmann; directions are
// unit vectors in the tangent frame, n = +z. What is outside is taken as the nearest inside, and
// no result is NaN or infinite for numbers that are neither.

fn student_t_closed_between(x: f32, low: f32, high: f32) -> f32 {
    let raised = select(low, x, x > low);
    return select(high, raised, raised < high);
}

// ln(1 + x) for x >= 0 with the digits of a small x.
fn student_t_closed_log_growth(x: f32) -> f32 {
    if x > 1.0 {
        return log(1.0 + x);
    }
    let y = x / (2.0 + x);
    let q = y * y;
    let tail = q * (1.0 / 9.0 + q * (1.0 / 11.0 + q * (1.0 / 13.0 + q * (1.0 / 15.0))));
    return 2.0 * y * (1.0 + q * (1.0 / 3.0 + q * (1.0 / 5.0 + q * (1.0 / 7.0 + tail))));
}

// Normal distribution function D(m): D(m) (m.n) integrates to 1 over all m. At most 3.4e38, where
// that of gamma < 2 has no limit, at the horizon.
fn student_t_closed_d(gamma: f32, sigma: vec2f, m: vec3f) -> f32 {
    if !(m.z > 0.0) {
        return 0.0;
    }
    // From 1e12 on the tails are those of infinity in single precision.
    let s = 1.0 / (student_t_closed_between(gamma, 1.501, 1e12) - 1.0);
    let x = student_t_closed_between(sigma.x, 1e-8, 1e6);
    let y = student_t_closed_between(sigma.y, 1e-8, 1e6);
    let z = student_t_closed_between(m.z, 1e-18, 1.0);
    let square = z * z;
    let part = s * ((m.x / x) * (m.x / x) + (m.y / y) * (m.y / y));
    // ln(1 + s tan^2 theta/sigma^2).
    let b = square + part;
    var growth = log(b) - 2.0 * log(z);
    if part < 1e3 * square {
        growth = student_t_closed_log_growth(part / square);
    }
    // The root, since D itself may overflow; 0.318 is 1/pi.
    let root = student_t_closed_between(exp(0.5 * (1.0 - 1.0 / s) * growth) / b, 0.0, 1e30);
    let limited = student_t_closed_between(sqrt(0.31830989 / (x * y)) * root, 0.0, 1.8446742e19);
    return limited * limited;
}

// Smith's masking G1(w) in [0, 1].
fn student_t_closed_masking(gamma: f32, sigma: vec2f, w: vec3f) -> f32 {
    let s = 1.0 / (student_t_closed_between(gamma, 1.501, 1e8) - 1.0);
    let x = student_t_closed_between(sigma.x, 1e-8, 1e6) * w.x;
    let y = student_t_closed_between(sigma.y, 1e-8, 1e6) * w.y;
    let t = sqrt(x * x + y * y);
    let c = student_t_closed_between(w.z, 0.0, 1.0);
    let kept = c * (t * t * t * (0.900976 + s * (-0.3294384 + s * -0.06063415)) + c * (t * t *
        (0.73478705 + s * s * (0.19656047 + s * -0.19010077)) + c * (t * (0.3181425 + s * (1.0 +
        s * (-0.8340435 + s * 0.1272497))) + c * (0.7100118 + s * (-0.9514865 + s * (0.42692533
        + s * -0.06434248))))));
    let lost = t * t * t * t * 0.25513962 + c * (t * t * t * (-0.2620338 + s * (0.30578956 + s *
        (0.07146245 + s * 0.0050674235))) + c * (t * t * (0.081733085 + s * (-0.14887473 + s *
        (0.061250158 + s * 0.0416899))) + c * t * (-0.007247091 + s * 0.007205088)));
    let whole = kept + lost;
    return select(0.0, student_t_closed_between(kept / whole, 0.0, 1.0), c > 0.0 && whole > 0.0);
}

// The directional albedo E under F = 1 and height-correlated masking, of sigma <= 1, gamma >= 1.6
// and cos_theta >= 0.02.
fn student_t_closed_albedo(gamma: f32, sigma: f32, cos_theta: f32) -> f32 {
    let s = 1.0 / (student_t_closed_between(gamma, 1.6, 1e8) - 1.0);
    let a = student_t_closed_between(sigma, 0.0, 1.0);
    let mu = student_t_closed_between(cos_theta, 0.02, 1.0);
    let rho = sqrt(mu * mu + a * a * (1.0 - mu * mu));
    let kept = 3.3654305e-7 + mu * mu * s * (-0.09420322 + s * 0.07624671) + rho * mu *
        (0.3136148 + s * -0.21505563 + mu * mu * (0.008847785 + s * -0.0085968515)) + a * (mu *
        (-0.41565076 + s * (0.6868197 + s * -0.24298689) + mu * (-0.36321938 + s * s *
        -0.01832113 + mu * 0.19258222)) + rho * (s * (-0.30483145 + s * 0.15806481) + mu * (s *
        0.22335671 + mu * -0.16841589)) + a * (0.81271976 + s * (-0.6325105 + s * 0.11692543) +
        mu * (-0.08764364 + mu * 0.14287566) + rho * (s * (0.41321215 + s * -0.17670779) + mu *
        s * -0.14536925) + a * (s * -0.08421658 + mu * (-0.07464519 + s * 0.1499401) + rho *
        (-0.15545358 + s * 0.11274045) + a * s * -0.028787045)));
    let lost = a * (s * (0.00015906361 + s * -9.568802e-5) + mu * (0.1657434 + s * (-0.14260508
        + s * 0.027638914) + mu * (s * (1.0 + s * -0.41001305) + mu * -0.016347516)) + rho *
        (-0.21144181 + s * (0.19568871 + s * -0.039693512) + mu * s * (-0.94561666 + s *
        0.38031635)) + a * (0.2156763 + s * (-0.21259208 + s * 0.0487627) + mu * (-0.021495936 +
        s * (0.6353526 + s * -0.107600436) + mu * (-0.050729755 + s * -0.8439411)) + rho * (s *
        (-0.7352435 + s * 0.15004599) + mu * (0.16557738 + s * 0.8293655)) + a * (s *
        (0.72921944 + s * -0.13085781) + mu * s * -0.24984965 + rho * -0.59916604 + a *
        0.59606653)));
    return student_t_closed_between(kept / (kept + lost), 0.0, 1.0);
}
