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
    let kept = 3.3654692e-7 + mu * mu * s * (-0.09420338 + s * 0.076246746) + rho * mu *
        (0.31361458 + s * -0.21505542 + mu * mu * (0.008847853 + s * -0.00859686)) + a * (mu *
        (-0.4156505 + s * (0.6868189 + s * -0.24298654) + mu * (-0.36321917 + s * s *
        -0.01832109 + mu * 0.19258194)) + rho * (s * (-0.3048304 + s * 0.15806425) + mu * (s *
        0.2233565 + mu * -0.16841584)) + a * (0.8127188 + s * (-0.6325103 + s * 0.116925605) +
        mu * (-0.087643385 + mu * 0.14287582) + rho * (s * (0.41321197 + s * -0.17670768) + mu *
        s * -0.14536908) + a * (s * -0.084216624 + mu * (-0.07464509 + s * 0.14993978) + rho *
        (-0.15545355 + s * 0.112740256) + a * s * -0.028786846)));
    let lost = a * (s * (0.00015906313 + s * -9.5687625e-5) + mu * (0.1657432 + s * (-0.14260493
        + s * 0.027638892) + mu * (s * (1.0 + s * -0.41001272) + mu * -0.01634746)) + rho *
        (-0.21144158 + s * (0.19568855 + s * -0.03969351) + mu * s * (-0.9456168 + s *
        0.38031608)) + a * (0.21567605 + s * (-0.21259187 + s * 0.04876267) + mu * (-0.021495847
        + s * (0.63535297 + s * -0.10760041) + mu * (-0.050729703 + s * -0.8439417)) + rho * (s
        * (-0.7352438 + s * 0.15004583) + mu * (0.16557702 + s * 0.8293662)) + a * (s *
        (0.7292196 + s * -0.13085759) + mu * s * -0.24985047 + rho * -0.5991651 + a *
        0.59606564)));
    return student_t_closed_between(kept / (kept + lost), 0.0, 1.0);
}
