//! Integration tests of the relay and the command line against real sockets. One binary, because each would link
//! the whole relay again.

mod command_line;
mod peers;
mod simulated_device;
