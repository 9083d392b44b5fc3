//! Integration tests of the relay and the command line against real sockets. One binary, because each would link
//! the whole relay again.

mod bad_target;
mod blocks;
mod capture;
mod command_line;
mod discover;
mod door;
mod foreign_client;
mod frames;
mod late_reply;
mod limits;
mod peers;
mod permit;
mod persistence;
mod reconnect;
mod shutdown;
mod slow_viewer;
mod websocket;
