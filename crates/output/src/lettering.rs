// SPDX-License-Identifier: MIT OR Apache-2.0
//! Text in pictures of pixels, in DejaVu Sans.
#![allow(
    clippy::cast_precision_loss,
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "sizes and places of letters within a picture"
)]

use ab_glyph::{Font, FontRef, Glyph, InvalidFont, PxScale, ScaleFont, point};

/// Returns the font of all pictures.
///
/// # Errors
/// Fails if the font in the program cannot be read.
pub(crate) fn picture_font() -> Result<FontRef<'static>, InvalidFont> {
    FontRef::try_from_slice(dejavu::sans::regular())
}

/// Places the letters of a text on the baseline `baseline`, from column 0 on. Returns them with the
/// width of the text. `em` is the size of the text in pixels.
pub(crate) fn place_letters(
    font: &FontRef<'_>,
    text: &str,
    em: f32,
    baseline: f32,
) -> (Vec<Glyph>, f32) {
    let height = font.height_unscaled();
    let scale = PxScale::from(em * height / font.units_per_em().unwrap_or(height));
    let font = font.as_scaled(scale);
    let mut caret = 0.0;
    let mut glyphs: Vec<Glyph> = Vec::new();
    for letter in text.chars() {
        let id = font.glyph_id(letter);
        caret += glyphs.last().map_or(0.0, |last| font.kern(last.id, id));
        glyphs.push(id.with_scale_and_position(scale, point(caret, baseline)));
        caret += font.h_advance(id);
    }
    (glyphs, caret)
}

/// Returns the width of a text in whole pixels. `em` is the size of the text in pixels.
#[must_use]
pub fn text_width(text: &str, em: u32) -> u32 {
    picture_font().map_or(0, |font| whole(place_letters(&font, text, em as f32, 0.0).1))
}

/// Draws a text whose letters stand on the row `baseline`, from the column `left` on. `blend` gets
/// the column and row of each pixel, and the share of it that the letters cover, from 0 to 1. `em`
/// is the size of the text in pixels; capitals have 0.73 of it. Returns the width of the text.
pub fn draw_text(
    text: &str,
    em: u32,
    (left, baseline): (u32, u32),
    mut blend: impl FnMut(u32, u32, f64),
) -> u32 {
    let Ok(font) = picture_font() else { return 0 };
    let (glyphs, width) = place_letters(&font, text, em as f32, baseline as f32);
    for glyph in glyphs {
        let Some(outline) = font.outline_glyph(glyph) else { continue };
        let corner = outline.px_bounds().min;
        outline.draw(|dx, dy, coverage| {
            let (x, y) = (corner.x.max(0.0) as u32 + dx, corner.y.max(0.0) as u32 + dy);
            blend(left + x, y, coverage.clamp(0.0, 1.0).into());
        });
    }
    whole(width)
}

fn whole(length: f32) -> u32 {
    length.ceil() as u32
}
