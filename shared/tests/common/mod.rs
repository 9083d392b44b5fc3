//! Frames recorded from other implementations. Each file says where its frames are from.
#![allow(dead_code, reason = "each test is a crate of its own and takes what it needs")]
#![expect(clippy::expect_used, reason = "a broken golden file is a bug in the test")]

use cipdeck_shared::wire::{Encapsulation, SendRrData};

/// The files of `golden/`.
const FILES: [(&str, &str); 4] = [
    ("ciplink", include_str!("../golden/ciplink.hex")),
    ("icsnpp", include_str!("../golden/icsnpp.hex")),
    ("omron_nx", include_str!("../golden/omron_nx.hex")),
    ("opener", include_str!("../golden/opener.hex")),
];

/// All frames of all files, named `file.frame`.
pub(crate) fn frames() -> Vec<(String, Vec<u8>)> {
    FILES.into_iter().flat_map(|(file, text)| parse(file, text)).collect()
}

/// One frame by its name, such as `opener.product_name_reply`.
pub(crate) fn frame(name: &str) -> Vec<u8> {
    let found = frames().into_iter().find(|(known, _)| known == name);
    found.unwrap_or_else(|| panic!("no frame {name}")).1
}

/// The message router bytes of a `SendRRData` frame.
pub(crate) fn message(name: &str) -> Vec<u8> {
    let frame = frame(name);
    let frame = Encapsulation::decode(&frame).expect("a whole frame");
    let data = SendRrData::decode(frame.data()).expect("a common packet");
    data.unconnected().expect("a message").data.to_vec()
}

/// `# comment`, `name =`, and indented lines of hexadecimal bytes.
fn parse(file: &str, text: &str) -> Vec<(String, Vec<u8>)> {
    let mut frames: Vec<(String, Vec<u8>)> = Vec::new();
    for line in text.lines().filter(|line| !line.is_empty() && !line.starts_with('#')) {
        if let Some(name) = line.strip_suffix(" =") {
            frames.push((format!("{file}.{name}"), Vec::new()));
        } else {
            let bytes =
                line.split_whitespace().map(|byte| u8::from_str_radix(byte, 16).expect("hexadecimal"));
            frames.last_mut().expect("a name comes first").1.extend(bytes);
        }
    }
    frames
}
