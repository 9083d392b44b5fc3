//! The one function that reads and writes a PLC's socket.

use std::io;
use std::pin::pin;
use std::time::SystemTime;

use cipdeck_shared::engine::LinkId;
use tokio::io::{AsyncRead, AsyncReadExt, AsyncWrite, AsyncWriteExt};
use tokio::sync::Notify;

/// What the driver moves bytes for.
pub(super) trait Machine {
    /// Appends what is to be written now: everything there is. Whoever has more wakes the driver again.
    fn poll_transmit(&self, link: LinkId, out: &mut Vec<u8>) -> bool;
    /// Hears what has been written, and when the write began: the answer may be there before it returns.
    fn written(&self, link: LinkId, bytes: &[u8], at: SystemTime);
    /// Takes what was read.
    fn handle_input(&self, link: LinkId, bytes: &[u8]);
}

/// Bytes of one read. A reply without fragmentation fits.
const READ_SIZE: usize = 4 * 1024;

/// Moves bytes until the other side closes. `wake` says that there is something to write.
///
/// Dropping this future drops the socket with it: a request that was cut in half can never be followed by another
/// one. Time limits are the engine's, who ends this future when one has passed.
pub(super) async fn drive<S>(mut io: S, link: LinkId, machine: &impl Machine, wake: &Notify) -> io::Result<()>
where
    S: AsyncRead + AsyncWrite + Unpin,
{
    let (mut out, mut input) = (Vec::new(), vec![0; READ_SIZE]);
    let mut woken = pin!(wake.notified());
    loop {
        tokio::select! {
            // Ours first: a target that never stops talking cannot keep us from it.
            biased;
            () = &mut woken => {
                // Bytes that come after this look wake again, even while these are being written.
                woken.set(wake.notified());
                if machine.poll_transmit(link, &mut out) {
                    tracing::trace!(link = link.0, bytes = ?out, "write");
                    let at = SystemTime::now();
                    io.write_all(&out).await?;
                    io.flush().await?;
                    machine.written(link, &out, at);
                    out.clear();
                }
            }
            read = io.read(&mut input) => match read? {
                0 => return Ok(()),
                length => {
                    let bytes = input.get(..length).unwrap_or_default();
                    tracing::trace!(link = link.0, ?bytes, "read");
                    machine.handle_input(link, bytes);
                }
            },
        }
    }
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    /// Answers `+1` to each byte.
    #[derive(Debug, Default)]
    struct Echo {
        bytes: Mutex<Vec<u8>>,
        wake: Notify,
    }

    impl Echo {
        fn say(bytes: Vec<u8>) -> Self {
            let echo = Self { bytes: Mutex::new(bytes), wake: Notify::new() };
            echo.wake.notify_one();
            echo
        }
    }

    impl Machine for Echo {
        fn poll_transmit(&self, _: LinkId, out: &mut Vec<u8>) -> bool {
            out.append(&mut self.bytes.lock().unwrap());
            !out.is_empty()
        }

        fn written(&self, _: LinkId, _: &[u8], _: SystemTime) {}

        fn handle_input(&self, _: LinkId, bytes: &[u8]) {
            self.bytes.lock().unwrap().extend(bytes.iter().map(|byte| byte + 1));
            self.wake.notify_one();
        }
    }

    #[tokio::test]
    async fn bytes_go_both_ways_through_a_pipe_of_one_byte_and_closing_ends_it() {
        let (ours, mut theirs) = tokio::io::duplex(1);
        let echo = Echo::say(vec![1, 2, 3]);
        let peer = async {
            let mut first = [0; 3];
            theirs.read_exact(&mut first).await.unwrap();
            assert_eq!(first, [1, 2, 3]);
            for byte in [10, 20] {
                theirs.write_all(&[byte]).await.unwrap();
                assert_eq!(theirs.read_u8().await.unwrap(), byte + 1);
            }
            // Something to say without having been asked.
            echo.bytes.lock().unwrap().push(99);
            echo.wake.notify_one();
            assert_eq!(theirs.read_u8().await.unwrap(), 99);
            drop(theirs);
        };
        let (ended, ()) = tokio::join!(drive(ours, LinkId(1), &echo, &echo.wake), peer);
        ended.unwrap();
    }

    #[tokio::test]
    async fn dropping_it_in_the_middle_of_a_write_closes_the_socket() {
        let (ours, mut theirs) = tokio::io::duplex(2);
        let echo = Echo::say(vec![7; 100]);
        {
            let driving = drive(ours, LinkId(1), &echo, &echo.wake);
            tokio::pin!(driving);
            let mut half = [0; 10];
            tokio::select! {
                _ = &mut driving => panic!("it ended by itself"),
                read = theirs.read_exact(&mut half) => read.unwrap(),
            };
        }
        let mut rest = Vec::new();
        theirs.read_to_end(&mut rest).await.unwrap();
        assert!(rest.len() < 90, "nothing is written after the drop");
    }
}
