//! What each byte of a table of words is.

use cipdeck_shared::{
    config::SendReqForm,
    dissect::{self, Node},
};

/// `Data_to_Send`: `sent` of its bytes go out.
pub(super) fn data_to_send(form: SendReqForm, bytes: &[u8], sent: usize) -> Node {
    let sent = sent.min(bytes.len());
    let at = (2 * form.head()).min(sent);
    let mut children = head(bytes, at);
    if let Some(request) = bytes.get(at..sent).filter(|request| !request.is_empty()) {
        let mut request = dissect::request(request);
        shift(&mut request, at);
        children.push(request);
    }
    if sent < bytes.len() {
        let is_filling = bytes.get(sent..) == Some(&[0]);
        let text = if is_filling { "fills the last word" } else { "Management_Param[3] ends before it" };
        children.push(leaf(sent, bytes.len(), "not sent", text.to_owned()));
    }
    parent(bytes.len(), children)
}

/// `Received_Data`: the reply to this request.
pub(super) fn received(bytes: &[u8], request: &[u8]) -> Node {
    let reply = dissect::reply(bytes, Some(request).filter(|request| !request.is_empty()));
    if bytes.len().is_multiple_of(2) {
        return reply;
    }
    let filling = leaf(bytes.len(), bytes.len() + 1, "not received", "fills the last word".to_owned());
    parent(bytes.len() + 1, vec![reply, filling])
}

/// Message type and IP address, as far as they are there.
fn head(bytes: &[u8], to: usize) -> Vec<Node> {
    let mut found = Vec::new();
    if to >= 2
        && let Some(&[low, high]) = bytes.get(..2).and_then(|word| <&[u8; 2]>::try_from(word).ok())
    {
        let kind = u16::from_le_bytes([low, high]);
        let text = match kind {
            0 => "0: unconnected".to_owned(),
            1 => "1: over a class 3 connection".to_owned(),
            other => format!("{other}: it is 0 (unconnected) or 1 (class 3 connection)"),
        };
        found.push(Node { error: kind > 1, ..leaf(0, 2, "message type", text) });
    }
    for at in 2..to {
        // 16#C0A8 is 192.168: the high byte of the word, which goes out last, comes first.
        let number = match at {
            2 => "2nd",
            3 => "1st",
            4 => "4th",
            _ => "3rd",
        };
        let value = bytes.get(at).copied().unwrap_or_default();
        found.push(leaf(at, at + 1, "IP address", format!("{value}, its {number} number")));
    }
    found
}

fn leaf(from: usize, to: usize, name: &'static str, text: String) -> Node {
    Node { from, to, name: name.into(), text, children: Vec::new(), error: false }
}

fn parent(to: usize, children: Vec<Node>) -> Node {
    Node { children, ..leaf(0, to, "words", String::new()) }
}

/// Inside of something larger.
fn shift(node: &mut Node, by: usize) {
    node.from += by;
    node.to += by;
    for child in &mut node.children {
        shift(child, by);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use cipdeck_shared::config::{bytes_of, read_words};

    fn said(form: SendReqForm, words: &str, sent: usize) -> Vec<(usize, usize, String, String)> {
        let node = data_to_send(form, &bytes_of(&read_words(words).unwrap()), sent);
        let leaves = node.leaves();
        leaves.iter().map(|it| (it.from, it.to, it.name.to_string(), it.text.clone())).collect()
    }

    #[test]
    fn every_byte_is_explained_once() {
        for (form, words, sent) in [
            (SendReqForm::Etc100, "0000 030E 0120 0124 0730", 10),
            (SendReqForm::Etc101, "0000 C0A8 0166 024E 4420 0124 0000 000A", 16),
            (SendReqForm::DataExch, "024E 4420 0124 0000 000A", 9),
            (SendReqForm::Etc101, "0000 C0A8", 4),
            (SendReqForm::Etc100, "0000 030E 0120", 0),
        ] {
            let leaves = said(form, words, sent);
            let covered: Vec<_> = leaves.iter().flat_map(|(from, to, ..)| *from..*to).collect();
            let all: Vec<_> = (0..2 * words.split(' ').count()).collect();
            assert_eq!(covered, all, "{words}: {leaves:?}");
        }
    }

    #[test]
    fn the_address_is_in_its_words_as_it_is_read() {
        let leaves = said(SendReqForm::Etc101, "0000 C0A8 0166 024E 4420 0124 0000 000A", 16);
        let text = |at: usize| leaves.iter().find(|(from, ..)| *from == at).unwrap().3.clone();
        assert_eq!([text(3), text(2)], ["192, its 1st number", "168, its 2nd number"]);
        assert_eq!([text(5), text(4)], ["1, its 3rd number", "102, its 4th number"]);
        assert!(text(6).contains("0x4e"), "{}", text(6));
    }

    #[test]
    fn what_stays_behind_is_said() {
        let last = said(SendReqForm::DataExch, "024E 4420 0124 0000 000A", 9).pop().unwrap();
        assert_eq!((last.0, last.2.as_str(), last.3.as_str()), (9, "not sent", "fills the last word"));
    }
}
