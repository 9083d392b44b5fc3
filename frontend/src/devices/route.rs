//! The addresses of this document's pages.

use crate::address::Pages;
pub use crate::address::{go, link, use_page};
use cipdeck_shared::config::{DeviceId, GroupId};

/// A page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// All devices.
    All,
    /// The form for one more.
    New,
    /// One device.
    Device(DeviceId),
    /// One group: its variables, live.
    Group(GroupId),
    /// Everything else.
    NotFound,
}

impl Pages for Page {
    fn read(path: &str) -> Self {
        let Some(rest) = path.trim_end_matches('/').strip_prefix("/devices") else { return Self::NotFound };
        match rest {
            "" => Self::All,
            "/new" => Self::New,
            _ => {
                let Some(id) = rest.strip_prefix('/') else { return Self::NotFound };
                let device = id.parse().map(Self::Device).ok();
                device.or_else(|| id.parse().map(Self::Group).ok()).unwrap_or(Self::NotFound)
            }
        }
    }

    fn path(self) -> String {
        match self {
            Self::All => "/devices".to_owned(),
            Self::New => "/devices/new".to_owned(),
            Self::Device(id) => format!("/devices/{id}"),
            Self::Group(id) => format!("/devices/{id}"),
            Self::NotFound => "/devices/404".to_owned(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_has_its_address() {
        for page in [Page::All, Page::New, Page::Device(DeviceId(7)), Page::Group(GroupId(12))] {
            assert_eq!(Page::read(&page.path()), page, "{page:?}");
        }
        assert_eq!(Page::read("/devices/"), Page::All);
        for path in ["/device", "/devicesx", "/devices/v1", "/devices/d", "/devices/d1/x", "/devices/-1"] {
            assert_eq!(Page::read(path), Page::NotFound, "{path}");
        }
    }
}
