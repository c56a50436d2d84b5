// SPDX-License-Identifier: MIT OR Apache-2.0
//! The vector instruction sets for which the inner loops are compiled; one is chosen at run time.
//!
//! The kernels are plain loops over blocks of a fixed number of elements. They are fast because the
//! compiler may use vector instructions for them. A [`VectorTask`] is compiled once per
//! [`InstructionSet`]. It is entered through a function that has the level's target features, into
//! which everything that the task calls is inlined.
//!
//! This is the only module with `unsafe`: calling a function with target features is sound only on
//! a processor that has them. [`InstructionSet::available`] asks the processor, and the private
//! field of [`InstructionSet`] makes sure that no other code can create a level.
#![allow(unsafe_code, reason = "entering code compiled for an instruction set that was detected")]

/// Work whose `run` (with everything that it calls) is marked `#[inline(always)]`, so that it is
/// compiled for the instruction set from which it is called.
pub trait VectorTask {
    /// Does the work.
    fn run(self);
}

/// Work over panels, which are rows of 32-bit values that fill two vector registers. It is inlined
/// like a [`VectorTask`], and is compiled once per level, with the panel size of that level.
pub trait PanelTask {
    /// Does the work on panels of `VALUES` values. `FUSED` says that a product is multiplied and
    /// added in one instruction, which rounds once.
    fn run<const VALUES: usize, const FUSED: bool>(self);
}

/// A [`PanelTask`] with a fixed panel size.
struct SizedPanelTask<T, const VALUES: usize, const FUSED: bool>(T);

impl<T: PanelTask, const VALUES: usize, const FUSED: bool> VectorTask
    for SizedPanelTask<T, VALUES, FUSED>
{
    #[inline(always)]
    fn run(self) {
        self.0.run::<VALUES, FUSED>();
    }
}

/// An instruction set that this processor has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct InstructionSet(InstructionSetKind);

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InstructionSetKind {
    Portable,
    #[cfg(target_arch = "x86_64")]
    Avx2,
    #[cfg(target_arch = "x86_64")]
    Avx512,
}

impl InstructionSet {
    /// The instruction set that every processor of the target has.
    pub const PORTABLE: Self = Self(InstructionSetKind::Portable);

    /// Returns the widest instruction set that this processor has.
    #[must_use]
    pub fn detect() -> Self {
        Self::available().last().copied().unwrap_or(Self::PORTABLE)
    }

    /// Returns all instruction sets that this processor has, the widest last.
    #[must_use]
    pub fn available() -> Vec<Self> {
        #[allow(unused_mut, reason = "only x86-64 has more than one")]
        let mut levels = vec![Self::PORTABLE];
        #[cfg(target_arch = "x86_64")]
        {
            let avx2 = is_x86_feature_detected!("avx2")
                && is_x86_feature_detected!("bmi2")
                && is_x86_feature_detected!("fma");
            let avx512 = is_x86_feature_detected!("avx512f")
                && is_x86_feature_detected!("avx512bw")
                && is_x86_feature_detected!("avx512dq")
                && is_x86_feature_detected!("avx512vl");
            if avx2 {
                levels.push(Self(InstructionSetKind::Avx2));
            }
            if avx2 && avx512 {
                levels.push(Self(InstructionSetKind::Avx512));
            }
        }
        levels
    }

    /// The name in reports.
    #[must_use]
    pub fn name(self) -> &'static str {
        match self.0 {
            InstructionSetKind::Portable => "portable",
            #[cfg(target_arch = "x86_64")]
            InstructionSetKind::Avx2 => "avx2",
            #[cfg(target_arch = "x86_64")]
            InstructionSetKind::Avx512 => "avx512",
        }
    }

    /// The bits of a vector register.
    #[must_use]
    pub fn register_bits(self) -> usize {
        match self.0 {
            InstructionSetKind::Portable => 128,
            #[cfg(target_arch = "x86_64")]
            InstructionSetKind::Avx2 => 256,
            #[cfg(target_arch = "x86_64")]
            InstructionSetKind::Avx512 => 512,
        }
    }

    /// Runs a task with these instructions.
    pub fn run(self, task: impl VectorTask) {
        match self.0 {
            InstructionSetKind::Portable => task.run(),
            // SAFETY: the field is private. Only `available` makes this value, and only after the
            // processor has reported every feature that the function enables.
            #[cfg(target_arch = "x86_64")]
            InstructionSetKind::Avx2 => unsafe { run_avx2(task) },
            // SAFETY: only `available` makes this value, as for AVX2.
            #[cfg(target_arch = "x86_64")]
            InstructionSetKind::Avx512 => unsafe { run_avx512(task) },
        }
    }

    /// The number of values in a panel: the 32-bit values of two vector registers.
    #[must_use]
    pub fn panel_lanes(self) -> usize {
        2 * self.register_bits() / 32
    }

    /// Runs a task with these instructions and with panels of [`InstructionSet::panel_lanes`]
    /// values.
    pub fn run_panels(self, task: impl PanelTask) {
        match self.0 {
            InstructionSetKind::Portable => SizedPanelTask::<_, 8, false>(task).run(),
            // SAFETY: only `available` makes this value, as in `run`.
            #[cfg(target_arch = "x86_64")]
            InstructionSetKind::Avx2 => unsafe { run_avx2(SizedPanelTask::<_, 16, true>(task)) },
            // SAFETY: only `available` makes this value, as in `run`.
            #[cfg(target_arch = "x86_64")]
            InstructionSetKind::Avx512 => unsafe {
                run_avx512(SizedPanelTask::<_, 32, true>(task));
            },
        }
    }
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi2,fma")]
fn run_avx2(task: impl VectorTask) {
    task.run();
}

#[cfg(target_arch = "x86_64")]
#[target_feature(enable = "avx2,bmi2,fma,avx512f,avx512bw,avx512dq,avx512vl")]
fn run_avx512(task: impl VectorTask) {
    task.run();
}

/// Asks the processor to load a value into its nearest cache, without waiting for it.
#[inline(always)]
pub fn prefetch<T>(value: &T) {
    #[cfg(target_arch = "x86_64")]
    {
        use std::arch::x86_64::{_MM_HINT_T0, _mm_prefetch};
        // SAFETY: a prefetch is a hint that neither faults nor changes memory, and every x86-64
        // processor has the instruction.
        unsafe { _mm_prefetch::<_MM_HINT_T0>(std::ptr::from_ref(value).cast()) };
    }
    #[cfg(not(target_arch = "x86_64"))]
    let _ = value;
}

#[cfg(test)]
mod tests {
    use super::*;

    struct CountingTask<'a>(&'a mut u32);

    impl VectorTask for CountingTask<'_> {
        #[inline(always)]
        fn run(self) {
            *self.0 += 1;
        }
    }

    struct VectorLengthTask<'a>(&'a mut usize);

    impl PanelTask for VectorLengthTask<'_> {
        #[inline(always)]
        fn run<const VALUES: usize, const FUSED: bool>(self) {
            *self.0 = VALUES;
        }
    }

    #[test]
    fn every_available_level_runs_its_task() {
        let levels = InstructionSet::available();
        let mut run_count = 0;
        for level in &levels {
            level.run(CountingTask(&mut run_count));
        }
        assert_eq!(usize::try_from(run_count).unwrap(), levels.len());
        for level in &levels {
            let mut elements = 0;
            level.run_panels(VectorLengthTask(&mut elements));
            assert_eq!(elements, level.panel_lanes());
        }
        assert_eq!(
            (levels[0].name(), levels.last()),
            ("portable", Some(&InstructionSet::detect()))
        );
    }
}
