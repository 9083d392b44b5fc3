//! Journeys through the page in headless Chromium against the real relay, with a screenshot of every stage. One
//! binary, because each would link the whole relay again.

mod code;
mod connections;
mod cyclic;
mod data;
mod deck;
mod desk;
mod devices;
mod editor;
mod first_start;
mod looking;
mod looks;
mod monitor;
mod office;
mod project;
mod reconnect;
mod routes;
mod silence;
mod words;
mod write;
