// SPDX-License-Identifier: MIT OR Apache-2.0
//! The containers and streams that ffmpeg may read for us, by the names of its demuxers.
//!
//! A file is what its first bytes say, whatever its name is, and some formats are lists of other files or addresses
//! (HLS, DASH, concat, IMF, image sequences), read further files beside the one that was named (MLV, VobSub), are
//! scripts (AviSynth, VapourSynth, lavfi), or take any text for a picture (tty). Only formats that hold their frames
//! themselves are read. References of MOV files to other files are off in ffmpeg by default.

/// Demuxers that read one file, and that one alone. Names that a build of ffmpeg does not know do no harm.
const NAMES: &[&str] = &[
    // Containers.
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
    // Streams without a container.
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
    // Single pictures.
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

/// The list as ffmpeg's option `-format_whitelist` takes it.
pub(super) fn allowed() -> String {
    NAMES.join(",")
}

/// The format of a file that ffmpeg has refused, by what it says of its first bytes when asked for everything.
pub(super) fn refused(said: &str) -> Option<&str> {
    let (_, rest) = said.split_once("] Format ").or_else(|| said.split_once("Format "))?;
    // The second follows where the first bytes are hardly enough for a guess.
    let ends = [" probed with ", " detected only with "];
    ends.into_iter().find_map(|end| rest.split_once(end)).map(|(name, _)| name)
}

/// Whether ffmpeg has refused a file because of the list.
pub(super) fn is_refusal(said: &str) -> bool {
    said.contains("Format not on whitelist")
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Formats that open other files or addresses, run scripts, or show text.
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
