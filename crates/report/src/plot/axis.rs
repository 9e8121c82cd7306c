//! Axes: the meaning of a coordinate, its range, scale and ticks.

/// One axis of a panel: quantity and unit, range, and whether its scale is logarithmic.
#[derive(Clone, Debug, PartialEq)]
pub struct Axis {
    /// Quantity and unit.
    pub label: String,
    low: f64,
    high: f64,
    log: bool,
    /// Ticks of an axis whose scale is neither even nor logarithmic, the most important first.
    marks: Vec<Tick>,
    /// Whether there are ticks between the numbers of a logarithmic scale.
    is_fine: bool,
    /// Whether numbers are degrees.
    is_angle: bool,
}

/// Steps of degrees, which divide a right angle.
const ANGLES: [f64; 7] = [1.0, 2.0, 5.0, 10.0, 15.0, 30.0, 45.0];

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Tick {
    /// Fraction of the axis: 0 at the low end, 1 at the high one.
    pub(super) at: f64,
    /// Its number; `None` between the numbers of a logarithmic axis.
    pub(super) label: Option<String>,
}

impl Axis {
    /// An axis with an even scale.
    ///
    /// # Panics
    /// Unless `low < high`, both finite.
    pub fn linear(label: impl Into<String>, low: f64, high: f64) -> Self {
        assert!(low < high && low.is_finite() && high.is_finite(), "a range of {low} to {high}");
        let (log, is_fine, is_angle, marks) = (false, true, false, Vec::new());
        Self { label: label.into(), low, high, log, marks, is_fine, is_angle }
    }

    /// An axis with an even scale of degrees; ` (°)` is added to the quantity.
    ///
    /// # Panics
    /// Unless `low < high`, both finite.
    pub fn degrees(quantity: impl AsRef<str>, low: f64, high: f64) -> Self {
        let label = format!("{} (°)", quantity.as_ref());
        Self { is_angle: true, ..Self::linear(label, low, high) }
    }

    /// An axis with a logarithmic scale.
    ///
    /// # Panics
    /// Unless `0 < low < high`, both finite.
    pub fn log(label: impl Into<String>, low: f64, high: f64) -> Self {
        assert!(0.0 < low, "a range of {low} to {high}");
        Self { log: true, ..Self::linear(label, low, high) }
    }

    /// The same without ticks between the numbers, for a small drawing.
    #[must_use]
    pub fn coarse(self) -> Self {
        Self { is_fine: false, ..self }
    }

    /// An axis from 0 to 1 of a quantity on any scale, by numbers with their fractions of the axis,
    /// the most important first. Where there is no room for all, the first are shown.
    ///
    /// # Panics
    /// Without a number, or if a fraction is outside [0, 1].
    pub fn marked(
        label: impl Into<String>,
        numbers: impl IntoIterator<Item = (f64, String)>,
    ) -> Self {
        let tick = |(at, label): (f64, String)| {
            assert!((0.0..=1.0).contains(&at), "{label} at {at}");
            Tick { at, label: Some(label) }
        };
        let marks: Vec<Tick> = numbers.into_iter().map(tick).collect();
        assert!(!marks.is_empty(), "an axis without a number");
        Self { marks, ..Self::linear(label, 0.0, 1.0) }
    }

    /// The value at a fraction of the axis's length.
    pub(crate) fn value(&self, fraction: f64) -> f64 {
        let [low, high] = self.ends();
        let x = low + (high - low) * fraction;
        if self.log { libm::exp10(x) } else { x }
    }

    /// The fraction of the axis at a value: 0 at the low end, 1 at the high one, outside [0, 1]
    /// beyond. On a logarithmic axis it is −∞ for 0 and NaN for negative values.
    pub fn fraction(&self, value: f64) -> f64 {
        let [low, high] = self.ends();
        let x = if self.log { libm::log10(value) } else { value };
        (x - low) / (high - low)
    }

    fn ends(&self) -> [f64; 2] {
        [self.low, self.high].map(|x| if self.log { libm::log10(x) } else { x })
    }

    /// Ticks of an axis with room for this many numbers.
    pub(super) fn ticks(&self, room: usize) -> Vec<Tick> {
        let room = room.max(2) as f64;
        if !self.marks.is_empty() {
            return self.marks_apart(1.0 / room);
        }
        // Two decades may hold one power only, which is no scale: then 1, 2 and 5 stand closer. Of
        // these, too, less than a decade may hold only one.
        for numbers_a_decade in [3.0, 2.0] {
            if !self.log {
                break;
            }
            let mut ticks = self.log_ticks(room, numbers_a_decade);
            ticks.retain(|tick| self.is_fine || tick.label.is_some());
            if ticks.iter().filter(|tick| tick.label.is_some()).count() > 1 {
                return ticks;
            }
        }
        self.even_ticks(room)
    }

    /// The most important marks that are no nearer to each other than this.
    fn marks_apart(&self, gap: f64) -> Vec<Tick> {
        let mut kept: Vec<Tick> = Vec::new();
        for tick in &self.marks {
            if kept.iter().all(|other| (other.at - tick.at).abs() >= gap) {
                kept.push(tick.clone());
            }
        }
        kept
    }

    /// Multiples of 1, 2 or 5 times a power of ten, or of a part of a right angle.
    fn even_ticks(&self, room: f64) -> Vec<Tick> {
        let rough = (self.high - self.low) / room;
        let is_enough = |step: &f64| self.is_angle && *step >= rough * 0.999;
        if let Some(step) = ANGLES.into_iter().find(is_enough) {
            return self.multiples(step, 0);
        }
        let power = libm::floor(libm::log10(rough));
        let unit = libm::exp10(power);
        let factor = [1.0, 2.0, 5.0].into_iter().find(|f| f * unit >= rough * 0.999);
        let (step, power) = factor.map_or((10.0 * unit, power + 1.0), |f| (f * unit, power));
        self.multiples(step, (-power).max(0.0) as usize)
    }

    fn multiples(&self, step: f64, decimals: usize) -> Vec<Tick> {
        let (first, last) = ((self.low / step - 1e-9).ceil(), (self.high / step + 1e-9).floor());
        (0..=(last - first) as u32)
            .map(|i| {
                // Adding 0 turns −0 into 0.
                let value = (first + f64::from(i)) * step + 0.0;
                let label = format!("{value:.decimals$}").replace('-', "−");
                Tick { at: self.fraction(value), label: Some(label) }
            })
            .collect()
    }

    /// 1, 2 and 5 times powers of ten where there is room for this many numbers in each decade;
    /// else the powers, or every n-th.
    fn log_ticks(&self, room: f64, numbers_a_decade: f64) -> Vec<Tick> {
        let [low, high] = self.ends();
        let decades = high - low;
        let numbered: &[u32] = if numbers_a_decade * decades <= room { &[1, 2, 5] } else { &[1] };
        let every = ((decades / room).ceil() as i32).max(1);
        let marked = if every == 1 { 1..=9 } else { 1..=1 };
        let powers = (low - 1e-9).floor() as i32..=(high + 1e-9).floor() as i32;
        let plain = self.low >= 1e-3 && self.high < 1e5;
        let tick = |mantissa: u32, power: i32| {
            // Parsed, so that 2e-3 is the number nearest to 0.002.
            let value = format!("{mantissa}e{power}").parse().expect("digits");
            let label = match (numbered.contains(&mantissa), mantissa) {
                (false, _) => None,
                _ if plain => Some(format!("{value}")),
                (_, 1) => Some(power_of_ten(power)),
                (_, m) => Some(format!("{m}·{}", power_of_ten(power))),
            };
            Tick { at: self.fraction(value), label }
        };
        powers
            .filter(|power| power.rem_euclid(every) == 0)
            .flat_map(|power| marked.clone().map(move |mantissa| tick(mantissa, power)))
            .filter(|tick| (-1e-9..=1.0 + 1e-9).contains(&tick.at))
            .collect()
    }
}

fn power_of_ten(power: i32) -> String {
    let raised = |c: char| match c {
        '-' => '⁻',
        '1' => '¹',
        '2' => '²',
        '3' => '³',
        digit => char::from_u32('⁰' as u32 + digit as u32 - '0' as u32).unwrap_or(digit),
    };
    format!("10{}", power.to_string().chars().map(raised).collect::<String>())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn labels(axis: &Axis, room: usize) -> Vec<String> {
        axis.ticks(room).into_iter().filter_map(|tick| tick.label).collect()
    }

    #[test]
    fn a_logarithmic_axis_has_1_2_5_where_there_is_room_and_powers_where_not() {
        let numbers = ["0.1", "0.2", "0.5", "1", "2", "5", "10"];
        assert_eq!(labels(&Axis::log("x", 0.1, 10.0), 8), numbers);
        assert_eq!(labels(&Axis::log("x", 0.1, 10.0), 4), ["0.1", "1", "10"]);
        assert_eq!(labels(&Axis::log("x", 1.5, 40.0), 4), ["2", "5", "10", "20"]);
        assert_eq!(labels(&Axis::log("x", 3e-7, 4e-6), 4), ["5·10⁻⁷", "10⁻⁶", "2·10⁻⁶"]);
        let powers = ["10⁻¹⁶", "10⁻¹²", "10⁻⁸", "10⁻⁴", "10⁰"];
        assert_eq!(labels(&Axis::log("x", 1e-16, 1.0), 5), powers);
        assert_eq!(Axis::log("x", 1.0, 10.0).coarse().ticks(4).len(), 4);
        // Between the numbers stand ticks without one, at 3, 4, 6 to 9.
        let ticks = Axis::log("x", 1.0, 10.0).ticks(4);
        assert_eq!(ticks.len(), 10);
        assert!((ticks[2].at - libm::log10(3.0)).abs() < 1e-15 && ticks[2].label.is_none());
    }

    #[test]
    fn a_narrow_logarithmic_axis_still_has_numbers() {
        assert_eq!(labels(&Axis::log("x", 2.2, 2.8), 4), ["2.2", "2.4", "2.6", "2.8"]);
    }

    #[test]
    fn an_even_axis_has_multiples_of_1_2_5() {
        assert_eq!(labels(&Axis::linear("x", -1.0, 1.0), 5), ["−1.0", "−0.5", "0.0", "0.5", "1.0"]);
        assert_eq!(labels(&Axis::linear("x", 0.0, 90.0), 6), ["0", "20", "40", "60", "80"]);
        let angles = Axis::degrees("x", -30.0, 90.0);
        assert_eq!(labels(&angles, 5), ["−30", "0", "30", "60", "90"]);
        assert_eq!(angles.label, "x (°)");
        assert_eq!(labels(&Axis::linear("x", 0.0, 3e4), 4), ["0", "10000", "20000", "30000"]);
    }

    #[test]
    fn where_marks_crowd_the_first_of_a_list_are_shown() {
        let numbers = [(0.0, "2"), (1.0, "∞"), (0.5, "5"), (0.52, "6"), (0.9, "50")];
        let axis = Axis::marked("γ", numbers.map(|(at, number)| (at, number.to_owned())));
        assert_eq!(labels(&axis, 5), ["2", "∞", "5"]);
        assert_eq!(labels(&axis, 11), ["2", "∞", "5", "50"]);
        assert_eq!((axis.fraction(0.25), axis.value(0.25)), (0.25, 0.25));
    }

    #[test]
    fn ends_corners_and_what_has_no_place() {
        let axis = Axis::log("x", 1e-9, 1e3);
        assert_eq!((axis.fraction(1e-9), axis.fraction(1e3)), (0.0, 1.0));
        assert!((axis.value(0.25) / 1e-6 - 1.0).abs() < 1e-12);
        assert_eq!(axis.fraction(0.0), f64::NEG_INFINITY);
        assert!(axis.fraction(-1.0).is_nan());
        assert_eq!(axis.fraction(f64::INFINITY), f64::INFINITY);
    }
}
