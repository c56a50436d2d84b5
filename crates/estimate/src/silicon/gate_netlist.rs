// SPDX-License-Identifier: MIT OR Apache-2.0
//! The netlist of a design in the cells of a library, with models of the cells, for a simulator.

use foveate_tools::{
    Cache, SynthesisJob, Toolchain,
    yosys::{self, YosysJob},
};

use super::error::SiliconError;
use super::job::SiliconJob;
use super::library::{CELLS, LibertyLibrary};
use super::mapping::map_array;

const MODELS: &str = "models.v";

/// Maps a design as [`map_to_silicon`](super::map_to_silicon) does, and returns the netlist as Verilog: the
/// modules of the array and of its units, and a model of each cell that they use, by its function in the
/// library.
///
/// # Errors
/// Fails if Yosys is missing or fails, if a cell has no model, and if a memory is too large for
/// flip-flops, because the netlist would not have its words.
pub fn gate_netlist(
    toolchain: &Toolchain,
    cache: &Cache,
    job: &SiliconJob,
    library: &LibertyLibrary,
) -> Result<String, SiliconError> {
    let synthesis = job.design.top_synthesis();
    let mapped = map_array(toolchain, cache, synthesis, library, job.memory_limit)?;
    mapped.check_memories(job.memory_limit)?;
    let script =
        format!("read_liberty -ignore_miss_func {CELLS}\nwrite_verilog -noattr {MODELS}\n");
    let job =
        YosysJob { sources: vec![library.source()], script, outputs: vec![MODELS.to_owned()] };
    let mut run = yosys::run(toolchain, cache, &job)?;
    let models = run.files.remove(MODELS).expect("it is the wanted file");
    let models = String::from_utf8_lossy(&models).into_owned();
    let texts = mapped.netlist.cell_types().into_iter().map(|cell| {
        yosys::module_text(&models, cell).ok_or_else(|| SiliconError::Netlist {
            reason: format!("there is no model of the cell `{cell}`"),
        })
    });
    let texts: String = texts.collect::<Result<_, _>>()?;
    Ok(with_parameters(mapped.gates, synthesis) + &texts)
}

/// Gives the array the parameters that its source has. They have one value, for which the netlist was
/// made.
fn with_parameters(gates: String, synthesis: &SynthesisJob) -> String {
    let parameters = synthesis.parameters.iter();
    let parameters = parameters.map(|(name, value)| format!("parameter {name} = {value}"));
    let parameters = parameters.collect::<Vec<_>>().join(", ");
    if parameters.is_empty() {
        return gates;
    }
    let head = format!("module {}(", synthesis.array);
    gates.replacen(&head, &format!("module {} #({parameters}) (", synthesis.array), 1)
}
