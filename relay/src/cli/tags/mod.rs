//! `cipdeck read`, `write` and `tags`: the tags of a controller, from here.

mod controller;
mod list;
mod read;
mod write;

use cipdeck_shared::config::{Profile, TargetPath};
use cipdeck_shared::plan::TagWay;
use cipdeck_shared::tag::{TagName, Type};
use clap::Args;

pub(super) use self::list::List;
pub(super) use self::read::Read;
pub(super) use self::write::Write;
use super::Exit;

/// Where the tags are.
#[derive(Clone, Debug, Args)]
pub(super) struct Place {
    /// The controller, as in TargetCfg.Path: 4,192.168.1.100 or 4,192.168.1.100,1,0
    #[arg(value_name = "PATH")]
    path: String,
    /// What it is: auto, generic, logix, micro800, omron; auto asks its Identity
    #[arg(long, value_name = "KIND", default_value = "auto", value_parser = profile)]
    profile: Profile,
    /// Over a class 3 connection, with larger packets where it takes them; a Micro800 is always asked so
    #[arg(long)]
    connected: bool,
    /// From a request to its reply, 250 to 10000
    #[arg(long, value_name = "MS", default_value_t = 3_000, value_parser = clap::value_parser!(u32).range(250..=10_000))]
    timeout: u32,
    /// For machines: JSON
    #[arg(long)]
    json: bool,
}

impl Place {
    fn way(&self) -> Result<TagWay, Exit> {
        let path: Result<TargetPath, _> = self.path.parse();
        let wrong = |error| {
            let rule = cipdeck_shared::plan::Rule::Path(error);
            Exit::usage(&format!("{:?} is no path: {rule}", self.path))
        };
        Ok(TagWay {
            path: path.map_err(wrong)?,
            profile: self.profile,
            connected: self.connected,
            timeout_ms: self.timeout,
        })
    }
}

fn profile(word: &str) -> Result<Profile, String> {
    let words: Vec<_> = Profile::ALL.iter().map(|profile| profile.word()).collect();
    Profile::of_word(word).ok_or_else(|| format!("one of {}", words.join(", ")))
}

/// A tag, and what somebody says that it is.
#[derive(Clone, Debug)]
struct Tag {
    name: TagName,
    kind: Option<Type>,
}

/// `Motor.Speed`, or with its type `Table=DINT[10]`.
fn tag(text: &str) -> Result<Tag, String> {
    let (name, kind) = text.split_once('=').map_or((text, None), |(name, kind)| (name, Some(kind)));
    let name = name.parse().map_err(|error| format!("{error}"))?;
    let kind = kind.map(str::parse).transpose().map_err(|error| format!("{error}"))?;
    Ok(Tag { name, kind })
}
