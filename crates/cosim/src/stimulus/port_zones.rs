// SPDX-License-Identifier: MIT OR Apache-2.0
//! The inputs that only a core with zones has, clock by clock: classes of regions, or words of the
//! memory of classes, and thresholds of regions that are keen or off.

use super::random::Random;
use foveate_camera::RegionClass;
use foveate_design::{CLASSES_PER_WORD, Design, class_word};
use foveate_model::{ClassMapInputs, ThresholdInputs, ZoneInputs};
use std::collections::VecDeque;

/// One in this many lanes gets another class when the map changes.
const LANES_PER_CHANGE: usize = 16;

/// The classes of the regions in a sequence.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum ClassChoice {
    /// All regions are normal.
    Normal,
    /// Classes change at random, also while frames are under way.
    Changing,
    /// The classes of the configuration. A lone unit is normal.
    Configured,
}

/// The inputs of zones.
#[derive(Clone, Debug)]
pub(super) struct PortZones {
    configured: Vec<RegionClass>,
    classes: Vec<RegionClass>,
    /// The memory of classes, if the core has one.
    memory: Option<ClassMemoryWriter>,
    pub(super) keen: ThresholdInputs,
    pub(super) off_summary_level: u32,
    /// True if the map changes, also while frames are under way.
    changes: bool,
}

#[derive(Clone, Debug)]
struct ClassMemoryWriter {
    /// The number of words that the address can number, also beyond the map.
    addresses: usize,
    /// The choices whose maps the committed and the other bank hold, where they are known.
    held: [Option<ClassChoice>; 2],
    /// True until the first sequence with a known map.
    is_new: bool,
    /// The inputs that write the map of a sequence, of the next clocks.
    planned: VecDeque<ClassMapInputs>,
    /// True if the planned inputs are applied, one at each clock.
    is_loading: bool,
    inputs: ClassMapInputs,
}

impl PortZones {
    /// Returns the inputs of a design with `lanes` pixels at its port, or `None` if it has no
    /// zones.
    pub(super) fn of_design(design: &Design, lanes: usize) -> Option<Self> {
        let configured = design.zones()?.configured_classes();
        let memory = design.has_class_memory().then(|| ClassMemoryWriter {
            addresses: 1 << design.class_address_bits(),
            held: [Some(ClassChoice::Configured); 2],
            is_new: true,
            planned: VecDeque::new(),
            is_loading: false,
            inputs: ClassMapInputs::default(),
        });
        let regions = if memory.is_some() { configured.len() } else { lanes };
        let normal = vec![RegionClass::Normal; regions];
        Some(Self {
            configured: if configured.len() == regions { configured.to_vec() } else { normal },
            classes: vec![RegionClass::Normal; regions],
            memory,
            keen: ThresholdInputs::of_class(design, RegionClass::Keen),
            off_summary_level: ThresholdInputs::of_class(design, RegionClass::Off).summary_level,
            changes: false,
        })
    }

    pub(super) fn begin_sequence(&mut self, choice: ClassChoice) {
        self.changes = choice == ClassChoice::Changing;
        match choice {
            ClassChoice::Configured => self.classes.copy_from_slice(&self.configured),
            ClassChoice::Normal | ClassChoice::Changing => self.classes.fill(RegionClass::Normal),
        }
        if let Some(memory) = &mut self.memory {
            memory.begin_sequence(choice, &self.classes);
        }
    }

    /// Returns the number of clocks that the next frame must wait until the classes of the sequence
    /// are in the memory of classes. From the next clock on, they are written.
    pub(super) fn load_clocks(&mut self) -> usize {
        self.memory.as_mut().map_or(0, |memory| {
            memory.is_loading = true;
            memory.planned.len()
        })
    }

    /// Begins a clock. A pipelined core takes a class only at the first step of a frame, and a
    /// memory of classes keeps frames from half a map, so the inputs may change at any clock.
    pub(super) fn begin_clock(&mut self, random: &mut Random) {
        if let Some(memory) = &mut self.memory {
            memory.begin_clock(self.changes, random);
            return;
        }
        if !self.changes || !random.one_in(3) {
            return;
        }
        for _ in 0..self.classes.len().div_ceil(LANES_PER_CHANGE) {
            let lane = random.index(self.classes.len() - 1);
            self.classes[lane] = RegionClass::ALL[random.index(RegionClass::ALL.len() - 1)];
        }
    }

    pub(super) fn inputs(&self) -> ZoneInputs<'_> {
        ZoneInputs {
            map: self.memory.as_ref().map(|memory| memory.inputs).unwrap_or_default(),
            ..self.inputs_without_writes()
        }
    }

    /// Returns the values of the inputs at a clock at which nothing is written.
    pub(super) fn inputs_without_writes(&self) -> ZoneInputs<'_> {
        ZoneInputs {
            classes: &self.classes,
            map: ClassMapInputs::default(),
            keen: &self.keen,
            off_summary_level: self.off_summary_level,
        }
    }
}

impl ClassMemoryWriter {
    /// Plans the writes for a sequence, unless the memory holds its map.
    fn begin_sequence(&mut self, choice: ClassChoice, classes: &[RegionClass]) {
        self.is_loading = false;
        self.planned.clear();
        match choice {
            ClassChoice::Changing => self.held = [None; 2],
            ClassChoice::Normal | ClassChoice::Configured => {
                // The second bank is committed before the first write, so that its first map is
                // used.
                if std::mem::take(&mut self.is_new) {
                    self.plan_commit(&[]);
                }
                if self.held[0] != Some(choice) {
                    let is_written = self.held[1] == Some(choice);
                    self.held[1] = Some(choice);
                    self.plan_commit(if is_written { &[] } else { classes });
                }
            }
        }
    }

    /// Plans the writes of a map word by word, and its commit, one clock after the other. At the
    /// last clock nothing is written, so that the next frame uses the map.
    fn plan_commit(&mut self, classes: &[RegionClass]) {
        self.held.swap(0, 1);
        let words = classes.chunks(CLASSES_PER_WORD as usize).map(class_word);
        let write = |(address, word)| ClassMapInputs { write: true, address, word, commit: false };
        let commit = ClassMapInputs { commit: true, ..ClassMapInputs::default() };
        self.planned.extend((0..).zip(words).map(write).chain([commit, ClassMapInputs::default()]));
    }

    fn begin_clock(&mut self, changes: bool, random: &mut Random) {
        self.inputs = match changes {
            true => self.random_inputs(random),
            false if self.is_loading => self.planned.pop_front().unwrap_or_default(),
            false => ClassMapInputs::default(),
        };
    }

    /// Returns random inputs: a word is written at about every second clock, and about as many are
    /// written between two commits as the memory has.
    fn random_inputs(&self, random: &mut Random) -> ClassMapInputs {
        let address = random.index(self.addresses - 1);
        ClassMapInputs {
            write: random.one_in(2),
            address: u32::try_from(address).expect("the number of a word has at most 32 bits"),
            word: u32::try_from(random.up_to(u32::MAX.into())).expect("a word has 32 bits"),
            commit: random.one_in(2 * self.addresses as u64),
        }
    }
}
