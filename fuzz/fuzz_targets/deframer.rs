//! A stream cut anywhere gives the same frames as the stream in one piece.
#![no_main]

use cipdeck_shared::wire::{Deframer, Header};
use libfuzzer_sys::fuzz_target;

type Frames = (Vec<(Header, Vec<u8>)>, bool);

fuzz_target!(|input: (&[u8], Vec<u8>)| {
    let (stream, cuts) = input;
    let whole = frames([stream]);
    let mut rest = stream;
    let mut pieces = Vec::new();
    for cut in cuts {
        let (piece, after) = rest.split_at(usize::from(cut).min(rest.len()));
        pieces.push(piece);
        rest = after;
    }
    pieces.push(rest);
    assert_eq!(frames(pieces), whole);
});

/// All frames, and whether the stream ended in nonsense.
fn frames<'a>(pieces: impl IntoIterator<Item = &'a [u8]>) -> Frames {
    let mut deframer = Deframer::new();
    let mut frames = Vec::new();
    for piece in pieces {
        deframer.push(piece);
        loop {
            match deframer.next_frame() {
                Ok(Some(frame)) => frames.push((frame.header, frame.data().to_vec())),
                Ok(None) => break,
                Err(error) => {
                    assert!(error.at <= deframer.pending(), "{error} lies in the bytes");
                    return (frames, true);
                }
            }
        }
    }
    (frames, false)
}
