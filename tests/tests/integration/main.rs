//! Integration tests of the relay and the command line against real sockets. One binary, because each would link
//! the whole relay again.

mod bad_target;
mod blocks;
mod capture;
mod class3;
mod command_line;
mod crash;
mod crowd;
mod described;
mod discover;
mod door;
mod foreign_client;
mod frames;
mod half_requests;
mod history;
mod late_reply;
mod limits;
mod logs;
mod network;
mod peers;
mod permit;
mod persistence;
mod random_inputs;
mod reconnect;
mod record;
mod routes;
mod scale;
mod scripts;
mod secrets;
mod security_model;
mod shutdown;
mod slow_viewer;
mod tag_clients;
mod tls;
mod websocket;
mod who;
