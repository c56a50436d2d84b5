// SPDX-License-Identifier: MIT OR Apache-2.0
//! The pins of a cell with its functions, capacitances, transition times and energies, from a
//! liberty file.

use std::collections::BTreeMap;

use super::error::SiliconError;
use super::liberty_text::{LibertyGroup, parse_tables};
use super::library::LibertyLibrary;
use super::logic_function::LogicFunction;
use super::lookup_table::{LookupTable, TableTemplates};

/// The cells that a netlist uses, in the units of their library.
#[derive(Clone, Debug)]
pub struct CellModels {
    /// The cells by name.
    pub cells: BTreeMap<String, CellModel>,
    /// The nominal voltage in volts.
    pub voltage: f64,
    /// The unit of capacitances in picofarads. Energies have this unit times one volt squared,
    /// which is a picojoule if it is 1.
    pub load_unit_pf: f64,
}

/// A combinational cell or a flip-flop.
#[derive(Clone, Debug, PartialEq)]
pub struct CellModel {
    /// The pins, without those of the supply.
    pub pins: Vec<CellPin>,
    /// The state of a flip-flop.
    pub state: Option<FlipFlopState>,
}

/// A pin of a cell.
#[derive(Clone, Debug, PartialEq)]
pub struct CellPin {
    /// The name of the pin.
    pub name: String,
    /// True for an output, and false for an input.
    pub is_output: bool,
    /// The capacitance of an input.
    pub capacitance: f64,
    /// The function of an output. Input i of it is pin i of the cell. The state of a flip-flop
    /// follows the pins, and then its inverse.
    pub function: Option<LogicFunction>,
    /// The energies that the cell takes itself when the pin changes.
    pub energies: Vec<InternalEnergy>,
    /// The transition times of an output.
    pub transitions: Vec<OutputTransition>,
}

/// The energies of a change of a pin, under a condition.
#[derive(Clone, Debug, PartialEq)]
pub struct InternalEnergy {
    /// The inputs of which any makes an output change; empty for an input and for any cause.
    pub related_pins: Vec<usize>,
    /// The condition, a function of pins and state. Without one, the energy is for all values that
    /// no condition of the same pins names.
    pub when: Option<LogicFunction>,
    /// The tables of a rise and of a fall, whose values are added up.
    pub tables: [Vec<LookupTable>; 2],
}

/// The transition times of an output after a change of an input.
#[derive(Clone, Debug, PartialEq)]
pub struct OutputTransition {
    /// The input.
    pub related_pin: usize,
    /// The relation of the edges of both.
    pub sense: TimingSense,
    /// The times of a rise and of a fall.
    pub tables: [Option<LookupTable>; 2],
}

/// The relation of the edges of an input and an output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TimingSense {
    /// A rise makes a rise.
    Same,
    /// A rise makes a fall.
    Opposite,
    /// Either edge may make either.
    Any,
}

/// The state of a flip-flop with a rising clock.
#[derive(Clone, Debug, PartialEq)]
pub struct FlipFlopState {
    /// The pin of the clock.
    pub clock: usize,
    /// The state after an edge.
    pub next: LogicFunction,
    /// The condition under which the state is 0 at once.
    pub clear: Option<LogicFunction>,
    /// The condition under which the state is 1 at once.
    pub preset: Option<LogicFunction>,
}

impl LibertyLibrary {
    /// Reads the models of cells.
    ///
    /// # Errors
    /// Fails if a cell is not there or is neither combinational nor a flip-flop with a rising
    /// clock, if a table cannot be read, or if the library has no voltage.
    pub fn cell_models<'a>(
        &self,
        names: impl IntoIterator<Item = &'a str>,
    ) -> Result<CellModels, SiliconError> {
        let library = parse_tables(self.text()).map_err(|fault| SiliconError::Liberty {
            path: self.path.clone(),
            line: fault.line,
            problem: fault.problem,
        })?;
        let templates = TableTemplates::of_library(&library);
        let groups: BTreeMap<&str, &LibertyGroup> =
            library.groups_of("cell").map(|cell| (cell.name.as_str(), cell)).collect();
        let mut cells = BTreeMap::new();
        for name in names {
            let problem = |problem: String| SiliconError::CellModel {
                cell: name.to_owned(),
                library: self.name.clone(),
                problem,
            };
            let group = groups.get(name).ok_or_else(|| problem("it is not there".to_owned()))?;
            let model = CellModel::from_group(group, (&library, &templates)).map_err(problem)?;
            cells.insert(name.to_owned(), model);
        }
        let no_voltage = || SiliconError::NoVoltage { library: self.name.clone() };
        let voltage = self.voltage.ok_or_else(no_voltage)?;
        let load_unit_pf = load_unit_pf(&library)
            .map_err(|unit| SiliconError::LoadUnit { library: self.name.clone(), unit })?;
        Ok(CellModels { cells, voltage, load_unit_pf })
    }
}

impl CellModel {
    fn from_group(
        cell: &LibertyGroup,
        (library, templates): (&LibertyGroup, &TableTemplates),
    ) -> Result<Self, String> {
        if ["bus", "bundle"].iter().any(|kind| cell.groups_of(kind).next().is_some()) {
            return Err("it has a bus or a bundle of pins".to_owned());
        }
        // A group may describe several pins.
        let groups: Vec<(&str, &LibertyGroup)> = cell
            .groups_of("pin")
            .flat_map(|pin| {
                let others = pin.other_arguments.iter().map(String::as_str);
                std::iter::once(pin.name.as_str()).chain(others).map(move |name| (name, pin))
            })
            .collect();
        let state = cell.groups_of("ff").next();
        if state.is_none()
            && ["ff_bank", "latch", "latch_bank", "statetable", "memory"]
                .iter()
                .any(|kind| cell.groups_of(kind).next().is_some())
        {
            return Err("it is neither a combinational cell nor a single flip-flop".to_owned());
        }
        let mut names: Vec<&str> = groups.iter().map(|(name, _)| *name).collect();
        let state_names = state.map(|state| {
            [state.name.as_str(), state.other_arguments.first().map_or("", String::as_str)]
        });
        names.extend(state_names.into_iter().flatten());
        let state = state.map(|state| FlipFlopState::from_group(state, &names)).transpose()?;
        let pins = groups.iter().map(|pin| CellPin::from_group(*pin, (library, templates), &names));
        Ok(Self { pins: pins.collect::<Result<_, _>>()?, state })
    }
}

impl FlipFlopState {
    fn from_group(state: &LibertyGroup, names: &[&str]) -> Result<Self, String> {
        let function = |name: &str| {
            let text = state.attribute(name)?;
            Some(
                LogicFunction::parse(text, names)
                    .ok_or(format!("`{name} : {text}` cannot be read")),
            )
        };
        let clock = function("clocked_on").ok_or("it has no clock".to_owned())??;
        let LogicFunction::Input(clock) = clock else {
            return Err("its clock is not the rise of a pin".to_owned());
        };
        Ok(Self {
            clock,
            next: function("next_state").ok_or("it has no next state".to_owned())??,
            clear: function("clear").transpose()?,
            preset: function("preset").transpose()?,
        })
    }
}

impl CellPin {
    fn from_group(
        (name, pin): (&str, &LibertyGroup),
        (library, templates): (&LibertyGroup, &TableTemplates),
        names: &[&str],
    ) -> Result<Self, String> {
        let is_output = match pin.attribute("direction") {
            Some("input") => false,
            Some("output") => true,
            _ => return Err(format!("its pin `{name}` is neither an input nor an output")),
        };
        let function = match (is_output, pin.attribute("function")) {
            (true, Some(text)) => {
                let function = LogicFunction::parse(text, names);
                Some(function.ok_or_else(|| format!("its function `{text}` cannot be read"))?)
            }
            (true, None) => return Err(format!("its output `{name}` has no function")),
            (false, _) => None,
        };
        let number = |group: &LibertyGroup, name: &str| {
            let number: f64 = group.attribute(name)?.trim().parse().ok()?;
            Some(number).filter(|number| number.is_finite() && *number >= 0.0)
        };
        let capacitance: Option<f64> = number(pin, "capacitance")
            .or_else(|| {
                Some((number(pin, "rise_capacitance")? + number(pin, "fall_capacitance")?) / 2.0)
            })
            .or_else(|| number(library, "default_input_pin_cap"));
        let energies = pin
            .groups_of("internal_power")
            .map(|group| InternalEnergy::from_group(group, templates, names));
        let transitions = pin
            .groups_of("timing")
            .filter_map(|group| OutputTransition::from_group(group, templates, names).transpose());
        Ok(Self {
            name: name.to_owned(),
            is_output,
            capacitance: if is_output { 0.0 } else { capacitance.unwrap_or(0.0) },
            function,
            energies: merged(energies.collect::<Result<_, _>>()?),
            transitions: transitions.collect::<Result<_, _>>()?,
        })
    }
}

impl InternalEnergy {
    fn from_group(
        group: &LibertyGroup,
        templates: &TableTemplates,
        names: &[&str],
    ) -> Result<Self, String> {
        let when = group.attribute("when");
        let when = when.map(|text| {
            LogicFunction::parse(text, names)
                .ok_or_else(|| format!("its condition `{text}` cannot be read"))
        });
        let tables = match group.groups_of("power").next() {
            Some(both) => {
                let table = table(both, templates)?;
                [Some(table.clone()), Some(table)]
            }
            None => tables(group, ["rise_power", "fall_power"], templates)?,
        };
        Ok(Self {
            related_pins: related_pins(group, names)?,
            when: when.transpose()?,
            tables: tables.map(|table| table.into_iter().collect()),
        })
    }

    /// Returns the energy of a rise (0) or of a fall (1).
    #[must_use]
    pub fn of_edge(&self, edge: usize, slew: f64, load: f64) -> f64 {
        self.tables[edge].iter().map(|table| table.value(slew, load)).sum()
    }
}

/// Joins energies of the same inputs under the same condition: one for each edge, or for each
/// supply.
fn merged(energies: Vec<InternalEnergy>) -> Vec<InternalEnergy> {
    let mut all: Vec<InternalEnergy> = Vec::new();
    for energy in energies {
        let is_same = |own: &&mut InternalEnergy| {
            own.related_pins == energy.related_pins && own.when == energy.when
        };
        match all.iter_mut().find(is_same) {
            None => all.push(energy),
            Some(own) => {
                let pairs = own.tables.iter_mut().zip(energy.tables);
                pairs.for_each(|(own, more)| own.extend(more));
            }
        }
    }
    all
}

impl OutputTransition {
    /// Reads the times of a group `timing`. One without transition times, such as a constraint, is
    /// no transition.
    fn from_group(
        group: &LibertyGroup,
        templates: &TableTemplates,
        names: &[&str],
    ) -> Result<Option<Self>, String> {
        let times = ["rise_transition", "fall_transition"];
        if times.iter().all(|kind| group.groups_of(kind).next().is_none()) {
            return Ok(None);
        }
        let Some(&related_pin) = related_pins(group, names)?.first() else { return Ok(None) };
        let sense = match group.attribute("timing_sense") {
            Some("positive_unate") => TimingSense::Same,
            Some("negative_unate") => TimingSense::Opposite,
            _ => TimingSense::Any,
        };
        Ok(Some(Self { related_pin, sense, tables: tables(group, times, templates)? }))
    }
}

fn related_pins(group: &LibertyGroup, names: &[&str]) -> Result<Vec<usize>, String> {
    let pin = |name: &str| {
        let pin = names.iter().position(|own| *own == name);
        pin.ok_or_else(|| {
            format!("it has no pin `{name}`, to which an energy or a time is related")
        })
    };
    group.attribute("related_pin").unwrap_or_default().split_whitespace().map(pin).collect()
}

fn tables(
    group: &LibertyGroup,
    kinds: [&'static str; 2],
    templates: &TableTemplates,
) -> Result<[Option<LookupTable>; 2], String> {
    let [rise, fall] = kinds
        .map(|kind| group.groups_of(kind).next().map(|group| table(group, templates)).transpose());
    Ok([rise?, fall?])
}

fn table(group: &LibertyGroup, templates: &TableTemplates) -> Result<LookupTable, String> {
    LookupTable::from_group(group, templates).ok_or_else(|| {
        format!(
            "its table `{} ({})` does not have one number for each point of a template of transition times and loads",
            group.kind, group.name
        )
    })
}

/// Returns the unit of capacitances in picofarads, which is 1 if the library does not say, or the
/// unit if it is not known.
fn load_unit_pf(library: &LibertyGroup) -> Result<f64, String> {
    let Some(list) = library.list("capacitive_load_unit") else { return Ok(1.0) };
    let unit = || {
        let number: f64 = list.first()?.trim().parse().ok()?;
        let factor = match list.get(1)?.trim().to_ascii_lowercase().as_str() {
            "pf" => 1.0,
            "ff" => 1e-3,
            _ => return None,
        };
        Some(number * factor).filter(|unit| unit.is_finite() && *unit > 0.0)
    };
    unit().ok_or_else(|| list.join(", "))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn library(text: &str) -> LibertyLibrary {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("a.lib");
        std::fs::write(&path, text).unwrap();
        LibertyLibrary::read(&path).unwrap()
    }

    const CELLS: &str = r#"library (tiny) { nom_voltage : 1.5; capacitive_load_unit (1000, ff);
        default_input_pin_cap : 0.5;
        power_lut_template (t) { variable_1 : input_transition_time; index_1 ("0, 1"); }
        cell (DFF) { ff (IQ, IQN) { clocked_on : "CK"; next_state : "D"; clear : "!R"; }
            pin (CK) { direction : input; capacitance : 0.1; internal_power () { when : "D Q"; rise_power (t) { values ("1, 2"); } } }
            pin (D) { direction : input; rise_capacitance : 0.2; fall_capacitance : 0.4; }
            pin (R) { direction : input; }
            pin (Q) { direction : output; function : "IQ"; internal_power () { related_pin : "CK"; power (t) { values ("3, 4"); } }
                timing () { related_pin : "CK"; timing_sense : non_unate; rise_transition (t) { values ("5, 6"); } }
                timing () { related_pin : "R"; timing_type : setup_rising; } } }
        cell (LAT) { latch (IQ, IQN) { enable : "G"; } }
        cell (NEG) { ff (IQ, IQN) { clocked_on : "!CK"; next_state : "D"; } pin (CK) { direction : input; } pin (D) { direction : input; } }
        cell (BAD) { pin (A) { direction : input; internal_power () { rise_power (none) { values ("1, 2"); } } } }
        cell (BUS) { bus (A) { direction : input; } }
        cell (OUT) { pin (Y) { direction : output; } }
        cell (REL) { pin (A) { direction : input; internal_power () { related_pin : "B"; } } }
        cell (TWO) { pin (A, B) { direction : input; capacitance : 1; } pin (Y) { direction : output; function : "A B";
            internal_power () { related_pin : "A B"; rise_power (t) { values ("1, 2"); } }
            internal_power () { related_pin : "A B"; fall_power (t) { values ("3, 4"); } }
            internal_power () { related_pin : "A B"; fall_power (t) { values ("5, 6"); } } } }
        cell (IO) { pin (A) { direction : inout; } }
    }"#;

    #[test]
    fn a_flip_flop_has_pins_energies_and_a_state() {
        let models = library(CELLS).cell_models(["DFF"]).unwrap();
        assert_eq!((models.voltage, models.load_unit_pf), (1.5, 1.0));
        let cell = &models.cells["DFF"];
        let state = cell.state.as_ref().unwrap();
        assert_eq!((state.clock, &state.next), (0, &LogicFunction::Input(1)));
        assert!(state.clear.is_some() && state.preset.is_none());
        let capacitances: Vec<f64> = cell.pins.iter().map(|pin| pin.capacitance).collect();
        assert!(capacitances.iter().zip([0.1, 0.3, 0.5, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12));
        assert_eq!(cell.pins[3].function, Some(LogicFunction::Input(4)));
        let [clock, output] = [0, 3].map(|pin: usize| &cell.pins[pin].energies[0]);
        assert!(clock.when.is_some() && clock.tables[1].is_empty());
        assert_eq!(output.related_pins, [0]);
        assert_eq!([0, 1].map(|edge| output.of_edge(edge, 1.0, 0.0)), [4.0, 4.0]);
        let [transition] = &cell.pins[3].transitions[..] else { panic!("one arc has times") };
        assert_eq!((transition.related_pin, transition.sense), (0, TimingSense::Any));
    }

    #[test]
    fn groups_of_several_pins_and_edges_are_joined() {
        let models = library(CELLS).cell_models(["TWO"]).unwrap();
        let pins = &models.cells["TWO"].pins;
        assert_eq!(pins.iter().map(|pin| pin.name.as_str()).collect::<Vec<_>>(), ["A", "B", "Y"]);
        let [energy] = &pins[2].energies[..] else { panic!("the three groups are one") };
        assert_eq!(energy.related_pins, [0, 1]);
        assert_eq!([0, 1].map(|edge| energy.of_edge(edge, 0.0, 0.0)), [1.0, 8.0]);
    }

    #[test]
    fn a_library_needs_a_voltage_and_known_units() {
        let cell = "cell (INV) { pin (A) { direction : input; } }";
        let found =
            |head: &str| library(&format!("library (a) {{ {head} {cell} }}")).cell_models(["INV"]);
        assert_eq!(
            found("nom_voltage : 1; capacitive_load_unit (10, FF);").unwrap().load_unit_pf,
            0.01
        );
        for (head, words) in [
            ("", "has no nominal voltage"),
            ("nom_voltage : nan;", "has no nominal voltage"),
            ("nom_voltage : 1; capacitive_load_unit (1, nf);", "`1, nf`"),
            ("nom_voltage : 1; capacitive_load_unit (1ff);", "`1ff`"),
        ] {
            let message = found(head).unwrap_err().to_string();
            assert!(message.contains(words), "{message}");
        }
    }

    #[test]
    fn other_cells_are_refused_with_the_reason() {
        let library = library(CELLS);
        for (cell, words) in [
            ("LAT", "nor a single flip-flop"),
            ("NEG", "not the rise of a pin"),
            ("BAD", "`rise_power (none)` does not have one number"),
            ("BUS", "a bus or a bundle"),
            ("OUT", "its output `Y` has no function"),
            ("REL", "it has no pin `B`"),
            ("IO", "neither an input nor an output"),
            ("NONE", "not there"),
        ] {
            let message = library.cell_models([cell]).unwrap_err().to_string();
            assert!(message.contains(cell) && message.contains(words), "{message}");
        }
    }
}
