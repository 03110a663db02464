//! Words that more than one kind of output needs.

/// A count of bytes with a binary unit.
pub fn bytes(count: u64) -> String {
    let count = count as f64;
    match count {
        c if c >= 1024.0 * 1024.0 => format!("{:.2} MiB", c / (1024.0 * 1024.0)),
        c if c >= 1024.0 => format!("{:.1} KiB", c / 1024.0),
        c => format!("{c} B"),
    }
}

/// Text made safe inside HTML.
pub fn escape(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}
