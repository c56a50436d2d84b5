// SPDX-License-Identifier: MIT OR Apache-2.0
//! The frame's border: RPUs whose second window repeats their region's own denoised pixels, where
//! their neighbors' shows halo.

use foveate_design::Design;
use foveate_lanes::{BLOCK, Block, Lane};
use foveate_model::region_border;

use crate::plan::index;
use crate::rows::{Memory, Row, row};

/// Bits of a border, as `border_i` has them.
const SIDES: [u8; 4] = [1, 2, 4, 8];

/// Which RPUs lie at which side, and room for nine rows of lanes.
#[derive(Clone, Debug)]
pub(crate) struct Borders<T: Lane> {
    /// Left, right, top, bottom; every bit is set in the lanes of RPUs at that side.
    masks: [Row<T>; 4],
    made: Memory<T>,
}

impl<T: Lane> Borders<T> {
    pub(crate) fn of(design: &Design) -> Self {
        let lanes = index(design.regions());
        let mask = |side: u8| {
            let mut mask: Row<T> = row(lanes);
            for (region, lane) in (0..design.regions()).zip(mask.iter_mut()) {
                if region_border(design, region) & side != 0 {
                    *lane = T::MAX;
                }
            }
            mask
        };
        Self { masks: SIDES.map(mask), made: Memory::new(9, lanes) }
    }

    /// The window of places `columns` x `rows` of a square that ends at `last`: where such a place is
    /// halo beyond the frame's border, one step in.
    #[inline(always)]
    pub(crate) fn window<'a>(
        &mut self,
        place: impl Fn(usize, usize) -> &'a [Block<T>],
        last: usize,
        columns: [usize; 3],
        rows: [usize; 3],
    ) -> [&[Block<T>]; 9] {
        let Self { masks: [left, right, top, bottom], made } = self;
        for at in 0..9 {
            let (x, y) = (columns[at % 3], rows[at / 3]);
            // The place one step in, and the RPUs that see it, for each direction.
            let (inner_x, beside) = match x {
                0 => (1, Some(&*left)),
                x if x == last => (last - 1, Some(&*right)),
                x => (x, None),
            };
            let (inner_y, above) = match y {
                0 => (1, Some(&*top)),
                y if y == last => (last - 1, Some(&*bottom)),
                y => (y, None),
            };
            let corners =
                [place(x, y), place(inner_x, y), place(x, inner_y), place(inner_x, inner_y)];
            let out = made.row_mut(at);
            for block in 0..out.len() {
                let beside = beside.map_or([T::default(); BLOCK], |mask| mask.blocks()[block]);
                let above = above.map_or([T::default(); BLOCK], |mask| mask.blocks()[block]);
                for lane in 0..BLOCK {
                    let [here, in_x, in_y, in_both] = corners.map(|row| row[block][lane]);
                    let upper = select(beside[lane], in_x, here);
                    let lower = select(beside[lane], in_both, in_y);
                    out[block][lane] = select(above[lane], lower, upper);
                }
            }
        }
        let made = &self.made;
        std::array::from_fn(|at| made.row(at))
    }
}

/// `yes` where the mask is set, otherwise `no`.
#[inline(always)]
fn select<T: Lane>(mask: T, yes: T, no: T) -> T {
    no ^ ((yes ^ no) & mask)
}
