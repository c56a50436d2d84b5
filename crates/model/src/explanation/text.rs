// SPDX-License-Identifier: MIT OR Apache-2.0
//! The text of an explanation for users, at most 80 columns wide.
//!
//! Regions up to 16x16 pixels are shown as numbers, hexadecimal above 8 bits, with a mark at every
//! hit. Larger regions are shown with one character per pixel, so that no row is cut off: ten
//! shades for pixels, `X` for a hit. The marks of `segment` are `+` above the mean and `-` below.

use std::fmt::{self, Display, Formatter, Write as _};

use foveate_camera::{Displacement, FeatureKind, RegionClass};

use crate::feature::surface::DisplacementSums;

use super::{
    DecisionExplanation, DifferenceSum, DisplacementExplanation, FeatureVote, RegionExplanation,
    RegionPosition, SegmentParts, SpatialExplanation, SquareRows, SummaryExplanation,
    TemporalExplanation,
};

/// Width of a terminal in columns.
const WIDTH: usize = 80;
/// Largest side of a region that is shown as numbers.
const MAX_NUMBER_SIDE: usize = 16;
/// The mark of a pixel that does not count.
const UNMARKED: char = ' ';
/// Shades from black to white.
const SHADES: &[u8; 10] = b" .:-=+*#%@";

impl Display for RegionExplanation {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        let grid = GridFormat::of(self);
        write_heading(f, self.frame, Some(&self.name), self.t_us)?;
        write_place(f, &self.region, self.class)?;
        writeln!(f, "{}", grid.note())?;
        grid.show(f, "raw", &self.raw, None)?;
        grid.show(f, &self.filter_text(), &self.denoised, None)?;
        for spatial in &self.spatial {
            spatial.show_marks(f, &grid, &self.denoised)?;
        }
        self.temporal.show_hits(f, &grid)?;
        writeln!(f)?;
        for spatial in &self.spatial {
            writeln!(f, "{}", spatial.line())?;
        }
        write_srs(f, self.srs, self.class, self.combine)?;
        let TemporalExplanation { count, min_count, .. } = self.temporal;
        write_trs(f, self.trs, count, min_count)?;
        if let Some(summary) = &self.summary {
            writeln!(f, "{:<9} {}", "means", summary.line())?;
        }
        write_rule(f, &self.rule)
    }
}

impl Display for DecisionExplanation {
    fn fmt(&self, f: &mut Formatter<'_>) -> fmt::Result {
        write_heading(f, self.frame, self.name.as_deref(), self.t_us)?;
        write_place(f, &self.region, self.class)?;
        writeln!(f, "an outcome has scores, but neither the pixels nor the reference\n")?;
        for vote in &self.spatial {
            let FeatureVote { feature, score, min_score, unit, vote, displacement, .. } = vote;
            write!(f, "{}", score_line(*feature, (*score, *min_score), *unit, *vote))?;
            if let Some(Displacement { dx, dy }) = displacement {
                write!(f, "\n{:<9} displacement {dx},{dy} since the reference", "")?;
            }
            writeln!(f)?;
        }
        write_srs(f, self.srs, self.class, self.combine)?;
        write_trs(f, self.trs, self.temporal.count, self.temporal.min_count)?;
        write_rule(f, &self.rule)
    }
}

/// Writes which frame is explained.
fn write_heading(f: &mut Formatter<'_>, frame: u64, name: Option<&str>, t_us: u64) -> fmt::Result {
    match name {
        Some(name) => writeln!(f, "frame {frame} ({}) at {t_us} us", shortened_name(name)),
        None => writeln!(f, "frame {frame} at {t_us} us"),
    }
}

/// Writes where the region lies, and its class.
fn write_place(
    f: &mut Formatter<'_>,
    place: &RegionPosition,
    class: Option<RegionClass>,
) -> fmt::Result {
    writeln!(
        f,
        "region {},{} of {} x {}, pixels x {} to {}, y {} to {}",
        place.x,
        place.y,
        place.columns,
        place.rows,
        place.x0,
        place.x0 + place.size - 1,
        place.y0,
        place.y0 + place.size - 1,
    )?;
    if place.padding_right + place.padding_below > 0 {
        let (right, below) = (place.padding_right, place.padding_below);
        writeln!(f, "padding: the last {right} columns and the last {below} rows")?;
    }
    class.map_or(Ok(()), |class| writeln!(f, "class {class}: {}", class_text(class)))
}

/// Writes spatial relevance, and the rule by which it follows from the votes.
fn write_srs(
    f: &mut Formatter<'_>,
    srs: bool,
    class: Option<RegionClass>,
    combine: &str,
) -> fmt::Result {
    let srs = u8::from(srs);
    match class.and_then(RegionClass::forced_srs) {
        None => writeln!(f, "{:<9} SRS {srs} ({combine} of the votes)", ""),
        Some(_) => writeln!(f, "{:<9} SRS {srs} (by the class, not by the votes)", ""),
    }
}

/// Writes temporal relevance, and the count that it follows from.
fn write_trs(f: &mut Formatter<'_>, trs: bool, count: u32, min_count: u32) -> fmt::Result {
    let (sign, trs) = (comparison_sign(trs), u8::from(trs));
    writeln!(f, "{:<9} {count} changed {sign} {min_count}: TRS {trs}", "temporal")
}

/// Writes the row of the decision table.
fn write_rule(f: &mut Formatter<'_>, rule: &str) -> fmt::Result {
    writeln!(f, "{:<9} {}", "decision", rule.replacen(": ", "\n          ", 1))
}

/// Returns the score of a feature, its threshold and its vote in words.
fn score_line(feature: FeatureKind, score: (u64, u64), unit: u64, is_vote: bool) -> String {
    let (score, min_score) = score;
    let sign = comparison_sign(is_vote);
    let vote = if is_vote { "votes" } else { "does not vote" };
    let mut line = format!("{:<9} {score} {sign} {min_score}: {vote}", feature.name());
    if unit > 1 {
        // Writing to a string cannot fail.
        let _ = write!(line, "; {} per pixel", quotient_text(score, unit));
    }
    line
}

impl RegionExplanation {
    /// Returns the title of the scored pixels: the filter and its effect.
    fn filter_text(&self) -> String {
        let Self { filter, .. } = self;
        if !filter.has_window() {
            return format!("scored ({filter})");
        }
        let pairs = self.raw.iter().flatten().zip(self.denoised.iter().flatten());
        let changes: Vec<u16> =
            pairs.map(|(raw, denoised)| raw.abs_diff(*denoised)).filter(|&by| by > 0).collect();
        match changes.iter().max() {
            None => format!("scored ({filter}): no pixel is changed"),
            Some(most) => {
                format!("scored ({filter}): {} pixels changed, by up to {most}", changes.len())
            }
        }
    }
}

impl SpatialExplanation {
    /// Shows the pixels that count.
    fn show_marks(
        &self,
        f: &mut Formatter<'_>,
        grid: &GridFormat,
        denoised: &SquareRows<u16>,
    ) -> fmt::Result {
        let Some(level) = self.level else { return Ok(()) };
        if let Some(hits) = &self.hits {
            let title = format!("{}: hits ({}), level {level}", self.feature, grid.mark());
            grid.show(f, &title, denoised, Some(&grid.hit_marks(hits)))?;
        }
        if let (Some(parts), Some(mean)) = (&self.parts, self.mean_text()) {
            let title =
                format!("{}: above (+) and below (-) the mean {mean}, level {level}", self.feature);
            grid.show(f, &title, denoised, Some(&parts.marks()))?;
        }
        Ok(())
    }

    /// Returns the mean in grey levels.
    fn mean_text(&self) -> Option<String> {
        let (mean, bits) = (self.mean?, self.mean_fraction_bits?);
        Some(if bits == 0 { mean.to_string() } else { quotient_text(mean, 1 << bits) })
    }

    fn line(&self) -> String {
        let scores = (self.score, self.min_score);
        let mut line = score_line(self.feature, scores, self.unit, self.vote);
        if let Some(parts) = &self.parts {
            let _ = write!(line, "; {} above, {} below", parts.count_above, parts.count_below);
        }
        if let Some(sums) = &self.displacements {
            let DisplacementSums { right, below, below_right, below_left } = sums;
            let _ = write!(
                line,
                "\n{:<9} the smallest of: right {right}, below {below},\n{:<9} below right \
                 {below_right}, below left {below_left}",
                "", ""
            );
        }
        if let Some(displacement) = &self.displacement {
            for words in displacement.lines() {
                let _ = write!(line, "\n{:<9} {words}", "");
            }
        }
        line
    }
}

impl DisplacementExplanation {
    /// Returns the movement in words, and the mean errors without and with it.
    fn lines(&self) -> Vec<String> {
        let Some(differences) = self.differences else {
            return vec!["there is no valid reference, so no movement can be found".to_owned()];
        };
        let still = differences.still.mean_text();
        match self.movement_text() {
            None => vec![
                "the content has not moved: the reference matches best as it stands,".to_owned(),
                format!("mean error {still}"),
            ],
            Some(movement) => vec![
                format!("the content has moved by {movement}:"),
                format!("mean error {still} as it stands,"),
                format!("{} moved", differences.displaced.mean_text()),
            ],
        }
    }

    /// Returns the columns and rows in words, or `None` for a displacement of 0.
    fn movement_text(&self) -> Option<String> {
        let part = |shift: i8, unit: &str, [back, forth]: [&str; 2]| {
            let (count, way) = (shift.unsigned_abs(), if shift < 0 { back } else { forth });
            let plural = if count == 1 { "" } else { "s" };
            (count > 0).then(|| format!("{count} {unit}{plural} {way}"))
        };
        let columns = part(self.displacement.dx, "column", ["to the left", "to the right"]);
        let rows = part(self.displacement.dy, "row", ["up", "down"]);
        let parts: Vec<_> = columns.into_iter().chain(rows).collect();
        (!parts.is_empty()).then(|| parts.join(" and "))
    }
}

impl DifferenceSum {
    /// Returns the mean in grey levels, with the sum and the number of pixels.
    fn mean_text(self) -> String {
        let Self { sum, pixels } = self;
        format!("{} ({sum} / {pixels})", quotient_text(sum, pixels))
    }
}

impl SegmentParts {
    /// Returns the marks of all pixels.
    fn marks(&self) -> SquareRows<char> {
        let row = |(above, below): (&Vec<bool>, &Vec<bool>)| {
            let sides = above.iter().zip(below);
            sides
                .map(|(&above, &below)| match (above, below) {
                    (true, _) => '+',
                    (false, true) => '-',
                    (false, false) => UNMARKED,
                })
                .collect()
        };
        self.above.iter().zip(&self.below).map(row).collect()
    }
}

impl TemporalExplanation {
    fn show_hits(&self, f: &mut Formatter<'_>, grid: &GridFormat) -> fmt::Result {
        match &self.reference {
            Some(reference) => {
                let mark = grid.mark();
                let title =
                    format!("reference ({}): changed ({mark}), level {}", self.against, self.level);
                grid.show(f, &title, reference, Some(&grid.hit_marks(&self.hits)))
            }
            None => {
                writeln!(f, "\nreference ({}): none is valid, every pixel counts", self.against)
            }
        }
    }
}

impl SummaryExplanation {
    /// Returns the means of this frame and those that the screen shows, row by row of blocks.
    fn line(&self) -> String {
        let list = |rows: &SquareRows<u16>| {
            let row = |row: &Vec<u16>| row.iter().map(u16::to_string).collect::<Vec<_>>().join(" ");
            rows.iter().map(row).collect::<Vec<_>>().join(", ")
        };
        let shown = match &self.shown {
            Some(shown) => format!("the screen shows {}", list(shown)),
            None => "the screen shows no summary".to_owned(),
        };
        format!("{}; {shown}; level {}", list(&self.means), self.level).replacen(
            "; ",
            "\n          ",
            1,
        )
    }
}

/// The format in which squares of pixels are shown.
struct GridFormat {
    side: usize,
    max: u16,
    /// Number of digits of a pixel.
    digits: usize,
    hexadecimal: bool,
}

impl GridFormat {
    fn of(explanation: &RegionExplanation) -> Self {
        let max = u16::MAX >> (16 - explanation.pixel_bits);
        let hexadecimal = explanation.pixel_bits > 8;
        let digits = if hexadecimal { format!("{max:x}") } else { max.to_string() };
        Self { side: explanation.raw.len(), max, digits: digits.len(), hexadecimal }
    }

    fn note(&self) -> &'static str {
        match (self.side > MAX_NUMBER_SIDE, self.hexadecimal) {
            (true, _) => {
                "one character per pixel: ten shades from black to white (the numbers are in\n\
                 --json), or a mark where a pixel counts"
            }
            (false, true) => "pixels are hexadecimal",
            (false, false) => "pixels are decimal",
        }
    }

    fn mark(&self) -> char {
        if self.side > MAX_NUMBER_SIDE { 'X' } else { '*' }
    }

    fn hit_marks(&self, hits: &SquareRows<bool>) -> SquareRows<char> {
        let row = |row: &Vec<bool>| {
            row.iter().map(|&hit| if hit { self.mark() } else { UNMARKED }).collect()
        };
        hits.iter().map(row).collect()
    }

    fn show(
        &self,
        f: &mut Formatter<'_>,
        title: &str,
        pixels: &SquareRows<u16>,
        marks: Option<&SquareRows<char>>,
    ) -> fmt::Result {
        writeln!(f, "\n{title}")?;
        for (y, row) in pixels.iter().enumerate() {
            let mut line = String::new();
            for (x, &pixel) in row.iter().enumerate() {
                let mark = marks.map(|marks| marks[y][x]);
                self.cell(&mut line, pixel, mark)?;
            }
            debug_assert!(line.len() <= WIDTH, "a row of the region fits");
            writeln!(f, "{}", line.trim_end())?;
        }
        Ok(())
    }

    /// Writes a pixel. `mark` is `None` in a square without marks.
    fn cell(&self, line: &mut String, pixel: u16, mark: Option<char>) -> fmt::Result {
        let width = self.digits;
        match (self.side > MAX_NUMBER_SIDE, mark) {
            (true, Some(mark)) => line.push(if mark == UNMARKED { '.' } else { mark }),
            (true, None) => {
                let shade = usize::from(pixel) * (SHADES.len() - 1) / usize::from(self.max.max(1));
                line.push(char::from(SHADES[shade]));
            }
            (false, mark) => {
                if self.hexadecimal {
                    write!(line, "{pixel:>width$x}")?;
                } else {
                    write!(line, "{pixel:>width$}")?;
                }
                line.push(mark.unwrap_or(UNMARKED));
            }
        }
        Ok(())
    }
}

/// Returns the effect of a class in words.
fn class_text(class: RegionClass) -> &'static str {
    match class {
        RegionClass::Normal => "the thresholds of the camera",
        RegionClass::Off => "SRS is 0, whatever the votes are",
        RegionClass::Keen => "the keen thresholds",
        RegionClass::Always => "SRS is 1, whatever the votes are",
    }
}

fn comparison_sign(reached: bool) -> &'static str {
    if reached { ">=" } else { "<" }
}

/// Returns `value / unit` with three digits after the point, rounded down.
fn quotient_text(value: u64, unit: u64) -> String {
    let thousandths = u128::from(value) * 1000 / u128::from(unit);
    format!("{}.{:03}", thousandths / 1000, thousandths % 1000)
}

/// Returns the end of a name that is too long.
fn shortened_name(name: &str) -> String {
    const MAX_LETTERS: usize = 40;
    let letters = name.chars().count();
    if letters <= MAX_LETTERS {
        return name.to_owned();
    }
    format!("...{}", name.chars().skip(letters - MAX_LETTERS + 3).collect::<String>())
}
