//! A controller that somebody at this machine asks about its tags.

use cipdeck_shared::plan::TagWay;

use crate::cli::Exit;
use crate::client::Client;
use crate::desk::Desk;
use crate::runner::Clock;
use crate::shutdown;

/// Runs a command with a controller, and says farewell to it however that ends.
pub(super) async fn with(way: TagWay, command: impl AsyncFnOnce(&mut Desk) -> Exit) -> Exit {
    let client = Client::start();
    // Whoever types the command has seen what it sends.
    let conversation = async {
        match Desk::open(client.lane("tags"), Clock::start(), way, None).await {
            Ok(mut desk) => command(&mut desk).await,
            Err(lost) => Exit::unanswered(&lost.reason),
        }
    };
    let exit = tokio::select! {
        exit = conversation => exit,
        () = shutdown::requested() => Exit::interrupted(&"interrupted; what had been sent may have been carried out"),
    };
    client.stop().await;
    exit
}
