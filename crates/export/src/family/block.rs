//! The block: a head with constants and offsets, weights of nodes of γ, numbers, and codes of 16
//! bits.

use microfacet_sampler::port::{ByShape, PartTables, VolumeTables, WindowCell};

use super::Family;
use super::codes::{Codes, Squares};

/// A member of the head, or some in braces.
#[derive(Clone, Debug)]
pub(crate) enum Item {
    Whole(u32),
    Number(f32),
    Group(Vec<Item>),
}

use Item::{Group, Number, Whole};

/// A family as lookups read it.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) head: Item,
    pub(crate) windows: Vec<WindowCell>,
    pub(crate) numbers: Vec<f32>,
    pub(crate) codes: Vec<u16>,
}

/// What codes may be off by: as much as keeps the text below 2.5 MB, and normals within 1e-5 of the
/// crate's cumulative distribution at a million points (`clients/c/run 1000000`). Slopes are half
/// tangents, whose cumulative distribution changes by up
/// to three times as much; a cell's slopes weigh 4/27 of its values at most.
const VALUES: f64 = 1.45e-6;
const SLOPES: f64 = 1.4e-5;
/// The first nodes of a half, of which codes are roots: tails of grazing views have half tangents
/// of 1e-5.
const TAIL: usize = 12;
/// Of slopes across, and of the slopes along those.
const ACROSS: [f64; 2] = [5e-7, 4e-6];
/// Of G1 over its coordinate, times the number of cells, and of the slopes along it.
const MASKING: [f64; 2] = [1e-6, 6e-6];
/// Of areas, as shares of the largest of their γ.
const AREA: f64 = 2.5e-6;
/// Of sqrt(1 - E), of other moments, and of log2(1 - E_avg).
const LOST: f64 = 6.8e-5;
const MOMENTS: f64 = 8e-4;
const LOGARITHM: f64 = 2.5e-4;

impl Block {
    /// Bytes of the head, and of the weights between two places of γ.
    pub(crate) const HEAD: usize = 4 * 127;
    pub(crate) const WINDOW: usize = 4 * 53;
    /// "StuT" in the order of a little-endian machine.
    pub(crate) const MAGIC: u32 = u32::from_le_bytes(*b"StuT");
    /// Rows of slopes whose codes have steps in common.
    pub(crate) const ROWS: usize = 16;

    pub(crate) fn new(family: &Family, layout: u32) -> Self {
        let mut block = Self { head: Whole(0), windows: vec![], numbers: vec![], codes: vec![] };
        // The sizes of all that comes before numbers, and before codes, are needed for offsets.
        let windows: usize = family.parts.iter().map(|part| part.windows.cells.len()).sum();
        let numbers_at = Self::HEAD + Self::WINDOW * windows;
        let mut offsets = Offsets { numbers_at, codes: vec![] };
        let mut parts: Vec<Item> =
            family.parts.iter().map(|part| block.part(part, &mut offsets)).collect();
        let empty = parts[0].zeroed();
        parts.resize(2, empty);
        let volumes = match &family.albedos {
            Some(albedos) => {
                albedos.iter().map(|table| block.volume(table, &mut offsets)).collect()
            }
            None => vec![Group(volume_of(None, [[0.0; 2]; 6], [0; 6])); 2],
        };
        let codes_at = numbers_at + 4 * block.numbers.len();
        if block.codes.len() % 2 == 1 {
            block.codes.push(0);
        }
        let bytes = codes_at + 2 * block.codes.len();
        let seam = if family.parts.len() > 1 { family.parts[0].gammas[0] } else { 0.0 };
        let mut head = Group(vec![
            Whole(Self::MAGIC),
            Whole(layout),
            Whole(bytes as u32),
            Number(seam),
            Whole(family.parts.len() as u32),
            Group(parts),
            Group(volumes),
        ]);
        offsets.place(&mut head, codes_at as u32);
        assert_eq!(4 * head.words().len(), Self::HEAD, "members of the head");
        block.head = head;
        block
    }

    /// The bytes of the block.
    pub(crate) fn bytes(&self) -> Vec<u8> {
        let windows = self.windows.iter().flat_map(|cell| {
            let starts = cell.starts.map(f32::from_bits);
            let weights = cell.weights.as_flattened().as_flattened().iter().copied();
            [cell.from, cell.inverse].into_iter().chain(starts).chain(weights)
        });
        let numbers = windows.chain(self.numbers.iter().copied()).map(f32::to_bits);
        let words = self.head.words().into_iter().chain(numbers).flat_map(u32::to_le_bytes);
        words.chain(self.codes.iter().flat_map(|code| code.to_le_bytes())).collect()
    }

    fn part(&mut self, part: &PartTables, offsets: &mut Offsets) -> Item {
        let windows = &part.windows;
        let windows_at = Self::HEAD + Self::WINDOW * self.windows.len();
        self.windows.extend(windows.cells.iter().map(|cell| WindowCell {
            from: short(cell.from),
            inverse: short(cell.inverse),
            starts: cell.starts,
            weights: cell.weights.map(|table| table.map(|power| power.map(short))),
        }));
        let slots = self.begin(offsets);
        self.codes.extend(&windows.slots);

        // Columns of slopes: by half, by node. The table ends with a row and a node to spare.
        let (shapes, columns) = (part.slopes.shapes, 2 * part.numbers);
        let values = &part.slopes.values;
        let real = values.len() - (columns + 1) * shapes;
        // By some rows, since those of grazing views have other slopes than those of steep ones.
        let slopes = self.begin(offsets);
        let mut starts = Vec::new();
        for group in values[..real].chunks(Self::ROWS * columns * shapes) {
            let column = |j: usize| {
                let places = (j * shapes..group.len()).step_by(columns * shapes);
                places.flat_map(|at| group[at..at + shapes].iter())
            };
            let is_tail = |j: usize| j % part.numbers < TAIL;
            let of_columns: Vec<(Codes, Squares, Codes)> = (0..columns)
                .map(|j| {
                    let of = |channel: usize| column(j).map(move |value| value[channel]);
                    // Slopes of tails are as small as they.
                    let order = (j % part.numbers + 1) as f64;
                    let along = Codes::of(of(1), SLOPES.min(3e-8 * order * order));
                    (Codes::of(of(0), VALUES), Squares::of(of(0)), along)
                })
                .collect();
            for (at, value) in group.iter().enumerate() {
                let j = at / shapes % columns;
                let (linear, squares, along) = &of_columns[j];
                let first = if is_tail(j) { squares.code(value[0]) } else { linear.code(value[0]) };
                self.codes.extend([first, along.code(value[1])]);
            }
            for (j, (linear, squares, along)) in of_columns.iter().enumerate() {
                let of_values = match is_tail(j) {
                    true => [squares.start, 0.0, squares.square],
                    false => [linear.start, linear.step, 0.0],
                };
                starts.extend(of_values.into_iter().chain([along.start, along.step]));
            }
            starts.extend([0.0; 5]);
        }
        // Beyond the last node of the last row, where it is read with weight 0.
        self.codes.extend(std::iter::repeat_n(0, 2 * shapes));
        let columns = self.numbers(offsets, starts);
        let cells = f64::from(part.masking_cells);
        let masking = self.coded(offsets, &part.masking, MASKING.map(|x| x / cells));
        // Areas over M₀ fall with 2γ − 3: as shares of the largest of their γ they keep digits.
        let of_shape = |j: usize| part.rests.values.iter().skip(j).step_by(part.rests.shapes);
        let largest: Vec<f32> = (0..part.rests.shapes.min(part.rests.values.len()))
            .map(|j| of_shape(j).fold(f32::MIN_POSITIVE, |most, cell| most.max(cell[0])))
            .collect();
        let scaled = |(i, cell): (usize, &[f32; 4])| cell.map(|x| x / largest[i % largest.len()]);
        let scaled = ByShape {
            shapes: part.rests.shapes,
            values: part.rests.values.iter().enumerate().map(scaled).collect(),
        };
        let [rests, starts] = self.coded(offsets, &scaled, [AREA; 4]);
        let rests = [rests, starts, self.numbers(offsets, largest)];
        let across = self.coded(offsets, &part.across, ACROSS);
        let rhos = self.numbers(offsets, part.rhos.as_flattened().iter().copied());
        let lines = part.lines;
        let per_row = if part.rhos.is_empty() { 0.0 } else { part.heavy_per_row };
        let whole = |count: usize| Whole(count as u32);
        Group(vec![
            Number(part.gammas[0]),
            Number(if part.gammas[1] > 1e17 { f32::MAX } else { part.gammas[1] }),
            Number(part.masking_scale),
            Group(vec![
                Whole(part.masking_crowded.into()),
                Number(part.masking_cells),
                Number(lines.cells),
                Number(lines.slopes[0]),
                Number(lines.slopes[1]),
                Number(lines.second),
                Number(lines.slopes[2]),
                whole(part.numbers),
                Number(part.scales[0]),
                Number(part.scales[1]),
                Number(per_row),
            ]),
            Number(windows.first),
            Number(windows.scale),
            whole(windows.slots.len()),
            Whole(windows.last.into()),
            Whole(slots),
            whole(windows_at),
            Group([shapes, part.across.shapes, part.masking.shapes].map(whole).into()),
            Whole(slopes),
            Whole(columns),
            Group(across.map(Whole).into()),
            Group(masking.map(Whole).into()),
            Group(rests.map(Whole).into()),
            Whole(rhos),
        ])
    }

    fn volume(&mut self, volume: &VolumeTables, offsets: &mut Offsets) -> Item {
        let averages = [0, 1, 2].map(|i| volume.averages.iter().map(move |node| node[i]));
        let tables = volume.values.iter().map(|table| &table[..]);
        let averages: Vec<Vec<f32>> = averages.into_iter().map(Iterator::collect).collect();
        let all = tables.chain(averages.iter().map(|table| &table[..]));
        let tolerances = [LOST, MOMENTS, MOMENTS, LOGARITHM, MOMENTS, MOMENTS];
        let mut codes = [[0.0; 2]; 6];
        let mut at = [0; 6];
        for (i, (table, tolerance)) in all.zip(tolerances).enumerate() {
            let of = Codes::of(table.iter().copied(), tolerance);
            at[i] = self.begin(offsets);
            self.codes.extend(table.iter().map(|&x| of.code(x)));
            codes[i] = [of.start, of.step];
        }
        Group(volume_of(Some(volume), codes, at))
    }

    /// The offset of codes that are added next: they begin with a word, since shaders read words.
    fn begin(&mut self, offsets: &mut Offsets) -> u32 {
        self.codes.resize(self.codes.len().next_multiple_of(2), 0);
        offsets.codes(self.codes.len())
    }

    /// Adds numbers, and returns their offset.
    fn numbers(&mut self, offsets: &Offsets, numbers: impl IntoIterator<Item = f32>) -> u32 {
        let at = offsets.numbers_at + 4 * self.numbers.len();
        self.numbers.extend(numbers.into_iter().map(short));
        at as u32
    }

    /// Adds a table as codes, and start and step of them by place and channel; a place of zeros
    /// follows, which is read with weight 0. Or finds those of an equal table: parts may have one
    /// in common. Returns both offsets.
    fn coded<const N: usize>(
        &mut self,
        offsets: &mut Offsets,
        table: &ByShape<N>,
        tolerances: [f64; N],
    ) -> [u32; 2] {
        let (mut codes, mut columns) = (Vec::new(), Vec::new());
        for place in table.values.chunks_exact(table.shapes.max(1)) {
            let of: [Codes; N] = std::array::from_fn(|i| {
                Codes::of(place.iter().map(|value| value[i]), tolerances[i])
            });
            for value in place {
                codes.extend(of.iter().zip(value).map(|(of, &x)| of.code(x)));
            }
            columns.extend(of.iter().flat_map(|of| [of.start, of.step]).map(short));
        }
        codes.extend(std::iter::repeat_n(0, N * table.shapes));
        columns.extend(std::iter::repeat_n(0.0, 2 * N));
        let found = self.codes.windows(codes.len().max(1)).step_by(2).position(|of| of == codes);
        let same = self.numbers.windows(columns.len()).position(|window| window == columns);
        if let (Some(codes), Some(columns)) = (found, same) {
            return [offsets.codes(2 * codes), (offsets.numbers_at + 4 * columns) as u32];
        }
        let at = self.begin(offsets);
        self.codes.extend(codes);
        [at, self.numbers(offsets, columns)]
    }
}

/// A number to seven digits, which makes a text shorter; the same for bytes.
fn short(x: f32) -> f32 {
    format!("{x:.6e}").parse().expect("a number")
}

/// The members of a volume; all 0 where there is none.
fn volume_of(volume: Option<&VolumeTables>, codes: [[f32; 2]; 6], at: [u32; 6]) -> Vec<Item> {
    let pair =
        |of: fn(&VolumeTables) -> [f32; 2]| Group(volume.map_or([0.0; 2], of).map(Number).into());
    let number = |of: fn(&VolumeTables) -> f32| Number(volume.map_or(0.0, of));
    vec![
        pair(|volume| volume.shapes),
        pair(|volume| volume.sigmas),
        pair(|volume| volume.first),
        pair(|volume| volume.density),
        number(|volume| volume.averages_first),
        number(|volume| volume.averages_density),
        Group(codes.map(|[start, _]| Number(start)).into()),
        Group(codes.map(|[_, step]| Number(step)).into()),
        Group(at.map(Whole).into()),
    ]
}

/// Where tables are. Those of codes are known when all numbers are: until then a mark stands for
/// each.
struct Offsets {
    numbers_at: usize,
    /// Places among the codes, by mark.
    codes: Vec<usize>,
}

/// Marks are larger than any offset.
const MARK: u32 = 0xff00_0000;

impl Offsets {
    /// A mark for the codes that begin at a place.
    fn codes(&mut self, at: usize) -> u32 {
        self.codes.push(at);
        MARK + self.codes.len() as u32 - 1
    }

    fn place(&self, item: &mut Item, codes_at: u32) {
        match item {
            Group(items) => items.iter_mut().for_each(|item| self.place(item, codes_at)),
            Whole(mark) if *mark >= MARK => {
                *mark = codes_at + 2 * self.codes[(*mark - MARK) as usize] as u32;
            }
            Whole(_) | Number(_) => (),
        }
    }
}

impl Item {
    /// Its words, in order.
    fn words(&self) -> Vec<u32> {
        match self {
            Whole(word) => vec![*word],
            Number(number) => vec![number.to_bits()],
            Group(items) => items.iter().flat_map(Self::words).collect(),
        }
    }

    fn zeroed(&self) -> Self {
        match self {
            Whole(_) => Whole(0),
            Number(_) => Number(0.0),
            Group(items) => Group(items.iter().map(Self::zeroed).collect()),
        }
    }
}
