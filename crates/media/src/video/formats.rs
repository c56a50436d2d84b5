// SPDX-License-Identifier: MIT OR Apache-2.0
//! The containers and streams that ffmpeg may read, by the names of its demuxers.
//!
//! The first bytes of a file decide its format, whatever its name. Some formats are lists of other
//! files or addresses (HLS, DASH, concat, IMF, image sequences), read further files beside the one
//! that was named (MLV, VobSub), are scripts (AviSynth, VapourSynth, lavfi), or render any text as
//! a picture (tty). Only formats that hold their frames themselves are read. ffmpeg does not follow
//! references of MOV files to other files by default.

/// The demuxers that read only the named file. Names that a build of ffmpeg does not know have no
/// effect.
const NAMES: &[&str] = &[
    // These are containers.
    "mov",
    "mp4",
    "m4a",
    "3gp",
    "3g2",
    "mj2",
    "matroska",
    "webm",
    "avi",
    "mpegts",
    "mpeg",
    "mpegvideo",
    "flv",
    "live_flv",
    "kux",
    "gif",
    "apng",
    "ogg",
    "asf",
    "asf_o",
    "mxf",
    "gxf",
    "nut",
    "nuv",
    "wtv",
    "rm",
    "dv",
    "ivf",
    "obu",
    "av1",
    "yuv4mpegpipe",
    "pva",
    "nsv",
    "dhav",
    "ifv",
    "flic",
    "smjpeg",
    "swf",
    "ty",
    "lxf",
    "jpegxl_anim",
    // These are streams without a container.
    "h261",
    "h263",
    "h264",
    "hevc",
    "vvc",
    "evc",
    "m4v",
    "mjpeg",
    "mjpeg_2000",
    "vc1",
    "vc1test",
    "dirac",
    "dnxhd",
    "cavsvideo",
    "avs2",
    "avs3",
    // These are single pictures.
    "bmp_pipe",
    "cri_pipe",
    "dds_pipe",
    "dpx_pipe",
    "exr_pipe",
    "gem_pipe",
    "gif_pipe",
    "hdr_pipe",
    "j2k_pipe",
    "jpeg_pipe",
    "jpegls_pipe",
    "jpegxl_pipe",
    "pam_pipe",
    "pbm_pipe",
    "pcx_pipe",
    "pfm_pipe",
    "pgm_pipe",
    "pgmyuv_pipe",
    "pgx_pipe",
    "phm_pipe",
    "photocd_pipe",
    "pictor_pipe",
    "png_pipe",
    "ppm_pipe",
    "psd_pipe",
    "qdraw_pipe",
    "qoi_pipe",
    "sgi_pipe",
    "sunrast_pipe",
    "tiff_pipe",
    "vbn_pipe",
    "webp_pipe",
    "xbm_pipe",
    "xpm_pipe",
    "xwd_pipe",
    "fits",
];

/// The usual demuxers of sound, which may hold a cover picture but no video.
const SOUND: &[&str] = &[
    "aac", "ac3", "aiff", "amr", "ape", "au", "caf", "dts", "eac3", "flac", "mp3", "oma", "tta",
    "w64", "wav", "wv",
];

pub(super) fn is_sound(name: &str) -> bool {
    SOUND.contains(&name)
}

/// Returns the list for ffmpeg's option `-format_whitelist`.
pub(super) fn allowed() -> String {
    NAMES.join(",")
}

/// Finds the format of a file that ffmpeg refused, in its debug messages about the first bytes.
pub(super) fn refused(said: &str) -> Option<&str> {
    let (_, rest) = said.split_once("] Format ").or_else(|| said.split_once("Format "))?;
    // The second phrase is used if the first bytes hardly suffice for a guess.
    let ends = [" probed with ", " detected only with "];
    ends.into_iter().find_map(|end| rest.split_once(end)).map(|(name, _)| name)
}

/// Returns true if ffmpeg refused a file because of the list.
pub(super) fn is_refusal(said: &str) -> bool {
    said.contains("Format not on whitelist")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// These formats open other files or addresses, run scripts, or render text.
    const HARMFUL: [&str; 23] = [
        "hls",
        "concat",
        "dash",
        "imf",
        "webm_dash_manifest",
        "image2",
        "image2pipe",
        "lavfi",
        "sdp",
        "rtsp",
        "rtp",
        "sap",
        "tty",
        "mlv",
        "vobsub",
        "avisynth",
        "vapoursynth",
        "svg_pipe",
        "mpjpeg",
        "ipmovie",
        "ffmetadata",
        "rawvideo",
        "tedcaptions",
    ];

    #[test]
    fn no_harmful_format_is_allowed() {
        let allowed = allowed();
        let mut names: Vec<&str> = allowed.split(',').collect();
        assert!(HARMFUL.iter().all(|name| !names.contains(name)));
        let count = names.len();
        names.sort_unstable();
        names.dedup();
        assert_eq!(names.len(), count, "a name stands twice");
    }

    #[test]
    fn the_format_is_named_by_what_ffmpeg_says() {
        let said = "[hls @ 0x5a] Format hls probed with size=2048 and score=100\n[hls @ 0x5a] Format not on whitelist 'mov'";
        assert!(is_refusal(said));
        assert_eq!(refused(said), Some("hls"));
        let said =
            "[tty @ 0x1] Format tty detected only with low score of 1, misdetection possible!\n";
        assert_eq!(refused(said), Some("tty"));
        assert_eq!(refused("Format not on whitelist 'mov'"), None);
    }
}
