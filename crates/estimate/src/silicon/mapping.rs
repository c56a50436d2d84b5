// SPDX-License-Identifier: MIT OR Apache-2.0
//! Maps an array to the cells of a library with Yosys ([`map_array`]). Large memories are cut
//! out, their ports become ports of the netlist, and macros are chosen that could hold them
//! ([`plan_memory`]).
//!
//! A memory whose words are read at a clock edge fits in macros with at least as many ports as
//! it reads and writes at a time. Its words are split over macros side by side, and its number
//! of words over macros one after the other; of all macros, those with the smallest area are
//! chosen. The logic that would select among macros is not counted.

use super::error::SiliconError;
use super::library::{CELLS, LibertyLibrary, MemoryShape};
use crate::error::EstimateError;
use crate::netlist::{AreaNetlist, NETLIST};
use crate::speed::count_to_f64;
use foveate_tools::yosys::{self, YosysJob};
use foveate_tools::{Cache, Source, SynthesisJob, Tool, ToolRecord, Toolchain};
use serde::{Deserialize, Serialize};
use serde_json::Value;

const CONSTRAINTS: &str = "abc.constr";
const BOX: &str = "memory_box.v";
const CUT: &str = "memory_cut.v";
/// The load of a port or register in femtofarads, for the sizing of gates.
const LOAD_FF: u32 = 10;
const MEMORIES: &str = "memories.json";
const GATES: &str = "gates.v";
const VERILOG: &str = "netlist.v";
/// The module that stands for a memory that is cut out.
const MEMORY_MODULE: &str = "foveate_memory";
/// The module with the ports of a memory that is cut out.
const BOX_TEXT: &str = include_str!("memory_box.v");
/// The rule by which Yosys replaces a memory of more than `LIMIT` bits.
const CUT_TEXT: &str = include_str!("memory_cut.v");

/// The netlist of an array in the cells of a library.
pub(super) struct MappedArray {
    pub(super) tool: ToolRecord,
    pub(super) netlist: AreaNetlist,
    /// The netlist as JSON, for the names of nets.
    pub(super) json: Value,
    /// The netlist as Verilog, with the ports of the source.
    pub(super) gates: String,
    /// The netlist as Verilog for OpenSTA.
    pub(super) verilog: String,
    pub(super) memories: Vec<UnmappedMemory>,
    /// True if gates were sized and buffers were added for their loads.
    pub(super) is_sized: bool,
}

impl MappedArray {
    /// Refuses an array of which a memory is not in the netlist, because it has more than `limit`
    /// bits.
    pub(super) fn check_memories(&self, limit: u64) -> Result<(), SiliconError> {
        match self.memories.iter().map(|memory| memory.words * memory.width).max() {
            None => Ok(()),
            Some(bits) => Err(SiliconError::MemoryTooLarge { bits, limit }),
        }
    }
}

/// A memory of a module that is not in the netlist.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct UnmappedMemory {
    pub(super) name: String,
    pub(super) width: u64,
    pub(super) words: u64,
    pub(super) reads: u64,
    pub(super) writes: u64,
    /// True if a word is read at a clock edge, as memories of a process do.
    pub(super) is_clocked: bool,
    /// The number of such memories in the array.
    pub(super) count: u64,
}

/// Maps the array. Memories of more than `limit` bits are cut out.
pub(super) fn map_array(
    toolchain: &Toolchain,
    cache: &Cache,
    synthesis: &SynthesisJob,
    library: &LibertyLibrary,
    limit: u64,
) -> Result<MappedArray, SiliconError> {
    let version = toolchain.find(Tool::Yosys)?.banner;
    let mut run = yosys::run(toolchain, cache, &mapping_job(synthesis, library, limit))?;
    let mut file = |name| run.files.remove(name).expect("it is one of the wanted files");
    let (before, after) =
        (json_value(MEMORIES, &file(MEMORIES))?, json_value(NETLIST, &file(NETLIST))?);
    Ok(MappedArray {
        tool: ToolRecord {
            name: "Yosys".to_owned(),
            version,
            flags: format!("synth -flatten, dfflibmap, abc; {} kept as a module", synthesis.unit),
        },
        memories: cut_memories(&before, &synthesis.array)?,
        netlist: AreaNetlist::from_value(NETLIST, &after)?,
        json: after,
        gates: String::from_utf8_lossy(&file(GATES)).into_owned(),
        verilog: String::from_utf8_lossy(&file(VERILOG)).into_owned(),
        is_sized: library.smallest_buffer().is_some(),
    })
}

/// Maps a module with its leaves as separate modules. Returns the netlist.
pub(super) fn map_leaves(
    toolchain: &Toolchain,
    cache: &Cache,
    synthesis: &SynthesisJob,
    library: &LibertyLibrary,
    (top, limit): (&str, u64),
) -> Result<AreaNetlist, SiliconError> {
    let script = format!(
        "{}synth -top {top}\n{}delete =A:blackbox\nwrite_json {NETLIST}\n",
        cut_commands(synthesis, "", top, "", ""),
        cell_commands(library.smallest_buffer())
    );
    let (sources, outputs) = (job_sources(synthesis, library, limit), vec![NETLIST.to_owned()]);
    let mut run = yosys::run(toolchain, cache, &YosysJob { sources, script, outputs })?;
    let json = run.files.remove(NETLIST).expect("it is the wanted file");
    Ok(AreaNetlist::parse(NETLIST, &json)?)
}

fn json_value(file: &'static str, bytes: &[u8]) -> Result<Value, EstimateError> {
    serde_json::from_slice(bytes).map_err(|source| EstimateError::UnreadableFile { file, source })
}

fn mapping_job(synthesis: &SynthesisJob, library: &LibertyLibrary, limit: u64) -> YosysJob {
    let SynthesisJob { unit, array, parameters, .. } = synthesis;
    let set: String =
        parameters.iter().map(|(name, value)| format!(" -set {name} {value}")).collect();
    let set = if set.is_empty() { set } else { format!("chparam{set} {array}\n") };
    let keep = format!("setattr -mod -set keep_hierarchy 1 {unit}\n");
    // Instances get plain names and buses become single nets, because OpenSTA of 2019 reads no
    // others.
    let script = format!(
        "{}synth -top {array} -flatten\n{}\
         rename -enumerate -pattern cell_%\n\
         delete =A:blackbox\n\
         write_verilog -noattr {GATES}\n\
         splitnets -ports\n\
         opt_clean -purge\n\
         write_json {NETLIST}\n\
         write_verilog -noattr -noexpr -nohex -nodec {VERILOG}\n",
        cut_commands(synthesis, &set, array, &keep, "flatten\n"),
        cell_commands(library.smallest_buffer())
    );
    let outputs = [MEMORIES, NETLIST, GATES, VERILOG].map(str::to_owned).to_vec();
    YosysJob { sources: job_sources(synthesis, library, limit), script, outputs }
}

/// Returns the commands that read the sources and cut large memories out.
fn cut_commands(
    synthesis: &SynthesisJob,
    set: &str,
    top: &str,
    keep: &str,
    flatten: &str,
) -> String {
    let names = synthesis.sources.iter().map(|(name, _)| name);
    let read = names.filter(|name| !name.ends_with(".vh"));
    let read: String = read.map(|name| format!("read_verilog -I. {name}\n")).collect();
    format!(
        "{read}{set}hierarchy -check -top {top}\n{keep}\
         proc\n{flatten}opt_expr\nopt_clean\nmemory -nomap\n\
         read_verilog {BOX}\n\
         techmap -autoproc -map {CUT}\n\
         opt_clean\n\
         write_json {MEMORIES}\n\
         expose -evert t:{MEMORY_MODULE}\n"
    )
}

/// Returns the commands that replace gates and registers by cells of the library.
fn cell_commands(buffer: Option<&str>) -> String {
    let constraints = buffer.map_or_else(String::new, |_| format!(" -constr {CONSTRAINTS}"));
    format!(
        "dfflibmap -liberty {CELLS}\n\
         abc -liberty {CELLS}{constraints}\n\
         setundef -zero\n\
         opt_clean -purge\n"
    )
}

/// Returns the files that the script reads.
fn job_sources(synthesis: &SynthesisJob, library: &LibertyLibrary, limit: u64) -> Vec<Source> {
    let mut sources = synthesis.sources.clone();
    sources.push(library.source());
    sources.push((BOX.to_owned(), BOX_TEXT.to_owned()));
    sources.push((CUT.to_owned(), CUT_TEXT.replace("LIMIT", &limit.to_string())));
    if let Some(buffer) = library.smallest_buffer() {
        let text = format!("set_driving_cell {buffer}\nset_load {LOAD_FF}\n");
        sources.push((CONSTRAINTS.to_owned(), text));
    }
    sources
}

/// Lists the memories that were cut out; those of all instances of a module are one entry.
fn cut_memories(json: &Value, array: &str) -> Result<Vec<UnmappedMemory>, SiliconError> {
    let counts = AreaNetlist::from_value(MEMORIES, json)?.instances(array, &[])?;
    let modules = json["modules"].as_object().into_iter().flatten();
    let mut found = Vec::new();
    for (module, content) in modules {
        let times = if module == array { 1 } else { counts.get(module).copied().unwrap_or(0) };
        let cells = content["cells"].as_object().into_iter().flatten();
        for (name, cell) in cells.filter(|(_, cell)| cell["type"] == MEMORY_MODULE) {
            let number = |parameter: &str| {
                let text = cell["parameters"][parameter].as_str().unwrap_or_default();
                u64::from_str_radix(text, 2).map_err(|_| SiliconError::Netlist {
                    reason: format!("the memory `{name}` has no number `{parameter}`"),
                })
            };
            found.push(UnmappedMemory {
                name: instance_path(name),
                width: number("WIDTH")?,
                words: number("WORDS")?,
                reads: number("READS")?,
                writes: number("WRITES")?,
                is_clocked: number("CLOCKED")? != 0,
                count: times,
            });
        }
    }
    found.retain(|memory| memory.count > 0);
    Ok(found)
}

/// Returns the instances on the path to a memory, without the generate blocks around them:
/// `u_forward.u_buffer`.
fn instance_path(name: &str) -> String {
    let path = name.trim_end_matches(".u_memory");
    let instances: Vec<&str> = path.split('.').filter(|part| part.starts_with("u_")).collect();
    if instances.is_empty() { path.to_owned() } else { instances.join(".") }
}

/// A memory of a module that is not mapped to cells.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MemoryFigures {
    /// The place of the memory in the design.
    pub name: String,
    /// The number of such memories.
    pub count: u64,
    /// The number of words of one of them.
    pub words: u64,
    /// The bits of a word.
    pub width: u64,
    /// The macros of one memory, or `None` if none fits.
    pub macros: Option<MacroChoice>,
}

/// The macros of a memory.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct MacroChoice {
    /// The cell of the library of macros.
    pub name: String,
    /// The number of macros.
    pub count: u64,
    /// The area of all of them in square micrometres.
    pub area_um2: f64,
}

impl MemoryFigures {
    /// Returns the bits of all memories of this size.
    #[must_use]
    pub fn bits(&self) -> u64 {
        self.count * self.words * self.width
    }
}

/// Chooses macros for a memory.
pub(super) fn plan_memory(memory: &UnmappedMemory, libraries: &[LibertyLibrary]) -> MemoryFigures {
    let macros = libraries.iter().flat_map(LibertyLibrary::memories);
    let fitting = macros.filter(|(_, shape, _)| fits(memory, *shape));
    let choices = fitting.map(|(name, shape, area)| {
        let count = memory.words.div_ceil(shape.words) * memory.width.div_ceil(shape.width);
        MacroChoice { name: name.to_owned(), count, area_um2: area * count_to_f64(count) }
    });
    MemoryFigures {
        name: memory.name.clone(),
        count: memory.count,
        words: memory.words,
        width: memory.width,
        macros: choices.min_by(|a, b| a.area_um2.total_cmp(&b.area_um2)),
    }
}

fn fits(memory: &UnmappedMemory, shape: MemoryShape) -> bool {
    memory.is_clocked && shape.ports as u64 >= memory.reads + memory.writes && shape.width > 0
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::path::Path;

    #[test]
    fn a_memory_is_named_by_its_instances() {
        let name = "g_forward.u_forward.u_buffer.g_inferred.words_q.u_memory";
        assert_eq!(instance_path(name), "u_forward.u_buffer");
        assert_eq!(instance_path("words_q.u_memory"), "words_q");
    }

    fn library(cells: &str) -> LibertyLibrary {
        let dir = tempfile::tempdir().unwrap();
        let path = dir.path().join("m.lib");
        std::fs::write(&path, format!("library (m) {{ {cells} }}")).unwrap();
        LibertyLibrary::read(Path::new(&path)).unwrap()
    }

    fn memory(words: u64, width: u64, is_clocked: bool) -> UnmappedMemory {
        UnmappedMemory {
            name: "u".to_owned(),
            width,
            words,
            reads: 1,
            writes: 1,
            is_clocked,
            count: 3,
        }
    }

    fn ram(name: &str, area: u32, (address, width): (u32, u32), ports: usize) -> String {
        let port = "bus (Q) { memory_read () { address : A; } } ".repeat(ports);
        format!(
            "cell ({name}) {{ area : {area}; memory () {{ address_width : {address}; word_width : {width}; }} {port} }} "
        )
    }

    #[test]
    fn the_smallest_macros_with_enough_ports_are_chosen() {
        let one_port = ram("one", 10, (6, 32), 1);
        let libraries = [
            library(&(one_port + &ram("small", 100, (6, 16), 2))),
            library(&ram("large", 350, (8, 16), 2)),
        ];
        let choice = |words, width| {
            plan_memory(&memory(words, width, true), &libraries)
                .macros
                .map(|own| (own.name, own.count, own.area_um2))
        };
        assert_eq!(choice(64, 16), Some(("small".to_owned(), 1, 100.0)));
        assert_eq!(choice(65, 17), Some(("small".to_owned(), 4, 400.0)));
        assert_eq!(choice(256, 16), Some(("large".to_owned(), 1, 350.0)));
        assert_eq!(choice(300, 31), Some(("small".to_owned(), 10, 1000.0)));
        let asynchronous = plan_memory(&memory(64, 16, false), &libraries);
        assert_eq!((asynchronous.bits(), asynchronous.macros), (3 * 64 * 16, None));
    }
}
