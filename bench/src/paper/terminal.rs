//! The figures as tables for the terminal.

use super::Paper;
use super::integrated::{CLAIM, MEASURES, RELATIVE, verdicts};
use super::method::Method;
use super::times::{GAMMAS, SIGMAS, Timing};
use crate::rows::Quantity;
use crate::settings::SIGMA;

impl Paper {
    pub(crate) fn text(&self) -> String {
        [self.times_text(), self.integrated_text(), self.compared_text()].join("\n")
    }

    /// Methods over γ: nanoseconds of one G1, and pictures relative to others.
    fn times_text(&self) -> String {
        let alone = |at: &Timing| Some(at.ns);
        let over_table = |at: &Timing| Some(at.ns / self.picture(Method::Table, at.gamma)?);
        let closed = self.picture(Method::Ggx, 2.0);
        let over_closed = |at: &Timing| Some(at.ns / closed?);
        let ggx = closed.map_or(String::new(), |ns| format!(", which takes {:.2} ms", 1e-6 * ns));
        let head = format!("figure 4, sigma {SIGMA}: ns of one G1");
        [
            self.by_gamma(&head, Quantity::G1, &alone),
            self.by_gamma(
                "a picture of rough gold, over that with the table",
                Quantity::Picture,
                &over_table,
            ),
            self.by_gamma(
                &format!("the same, over GGX's closed form{ggx}"),
                Quantity::Picture,
                &over_closed,
            ),
        ]
        .join("\n")
    }

    /// Nanoseconds of a picture of this method and shape, if it was timed.
    fn picture(&self, method: Method, gamma: f64) -> Option<f64> {
        let of = self.times.iter().filter(|time| {
            time.quantity == Quantity::Picture && time.by_gamma && time.method == method
        });
        of.clone().find(|time| time.gamma == gamma).map(|time| time.ns)
    }

    /// A table of methods over γ, with Beckmann in the last column.
    fn by_gamma(
        &self,
        head: &str,
        quantity: Quantity,
        value: &dyn Fn(&Timing) -> Option<f64>,
    ) -> String {
        let of: Vec<&Timing> =
            self.times.iter().filter(|at| at.quantity == quantity && at.by_gamma).collect();
        let mut methods: Vec<Method> = of.iter().map(|at| at.method).collect();
        methods.sort();
        methods.dedup();
        let shapes: Vec<f64> = GAMMAS.into_iter().chain([f64::INFINITY]).collect();
        let cell = |method: Method, gamma: f64| {
            let at = of.iter().find(|at| at.method == method && at.gamma == gamma);
            at.and_then(|at| value(at)).map_or(String::new(), significant)
        };
        let rows = methods.into_iter().map(|method| (method.name().into(), method));
        grid(head, &shapes, rows, |&method, gamma| cell(method, gamma))
    }

    /// Each measure with its largest value, and where it keeps the paper's claim; by γ, and one of
    /// them by σ too.
    fn integrated_text(&self) -> String {
        let claim = format!("{:.1} %", 1e2 * CLAIM);
        let [first, last] = [SIGMAS[0], SIGMAS[SIGMAS.len() - 1]];
        let mut text = format!(
            "figure 5: error of the rational approximation of G1, sigma {first} to {last}; the \
             paper has {claim}\n{:32} {:>9} {:>9} {:>6}  below {claim} at every sigma\n",
            "measure", "largest", "at gamma", "sigma"
        );
        for verdict in verdicts(&self.integrated) {
            let sigma = verdict.sigma.map_or("any".into(), |sigma| sigma.to_string());
            let range = |[low, high]: &[f64; 2]| [*low, *high].map(significant).join(" to ");
            let ranges: Vec<String> = verdict.below.iter().map(range).collect();
            let below = if ranges.is_empty() {
                "for no gamma".into()
            } else {
                format!("for gamma {}", ranges.join(", "))
            };
            text += &format!(
                "{:32} {:>7.3} % {:>9} {sigma:>6}  {below}\n",
                verdict.measure.formula,
                1e2 * verdict.worst,
                significant(verdict.gamma),
            );
        }
        let percent = |measure: usize, gamma: f64, sigma: f64| {
            let at = self.integrated.iter().find(|at| at.gamma == gamma && at.sigma == sigma);
            at.map_or(String::new(), |at| format!("{:.3}", 1e2 * at.errors[measure]))
        };
        let measures = MEASURES.iter().enumerate().map(|(i, of)| (of.formula.to_string(), i));
        let by_measure =
            grid(&format!("in per cent, sigma {SIGMA}"), &GAMMAS, measures, |&i, gamma| {
                percent(i, gamma, SIGMA)
            });
        let sigmas = SIGMAS.into_iter().map(|sigma| (format!("sigma {sigma}"), sigma));
        let head = format!("in per cent, {}", MEASURES[RELATIVE].formula);
        let by_sigma =
            grid(&head, &GAMMAS, sigmas, |&sigma, gamma| percent(RELATIVE, gamma, sigma));
        [text, by_measure, by_sigma].join("\n")
    }

    fn compared_text(&self) -> String {
        let mut text = format!(
            "figure 6, rough gold, sigma {SIGMA}: differences to the picture with the exact G1, in \
             radiance\nand in steps of 1/255\n{:>5} {:22} {:>9} {:>9} {:>12} {:>12}\n",
            "gamma", "form", "RMSE", "relative", "RMSE, steps", "most, steps"
        );
        for of_shape in &self.compared {
            for at in &of_shape.differences {
                text += &format!(
                    "{:>5} {:22} {:>9.1e} {:>9.1e} {:>12.1e} {:>12.1e}\n",
                    of_shape.gamma, at.form, at.rmse, at.relative, at.steps, at.most_steps
                );
            }
        }
        text
    }
}

/// A table of named rows over γ.
fn grid<T>(
    head: &str,
    gammas: &[f64],
    rows: impl Iterator<Item = (String, T)>,
    cell: impl Fn(&T, f64) -> String,
) -> String {
    let mut text = format!("{head}\n{:32}", "gamma");
    text.extend(gammas.iter().map(|gamma| format!("{gamma:>7}")));
    text.push('\n');
    for (name, row) in rows {
        let mut line = format!("{name:32}");
        line.extend(gammas.iter().map(|&gamma| format!("{:>7}", cell(&row, gamma))));
        text += line.trim_end();
        text.push('\n');
    }
    text
}

/// A number with three digits, or with those before its point.
fn significant(x: f64) -> String {
    match x.abs() {
        size if size < 9.995 => format!("{x:.2}"),
        size if size < 99.95 => format!("{x:.1}"),
        _ => format!("{x:.0}"),
    }
}
