//! The addresses of this document's pages.

use crate::address::Pages;
pub use crate::address::{link, use_page};
use cipdeck_shared::config::BlockId;

/// A page.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Page {
    /// Code in: from text to blocks.
    Import,
    /// Code out: a block in every dialect, and as another block.
    Export(BlockId),
    /// All blocks, devices and groups as files.
    Project,
    /// Everything else.
    NotFound,
}

impl Pages for Page {
    fn read(path: &str) -> Self {
        let Some(rest) = path.trim_end_matches('/').strip_prefix("/code") else { return Self::NotFound };
        match rest {
            "" => Self::Import,
            "/project" => Self::Project,
            _ => {
                let id = rest.strip_prefix('/').and_then(|id| id.parse().ok());
                id.map_or(Self::NotFound, Self::Export)
            }
        }
    }

    fn path(self) -> String {
        match self {
            Self::Import => "/code".to_owned(),
            Self::Export(id) => format!("/code/{id}"),
            Self::Project => "/code/project".to_owned(),
            Self::NotFound => "/code/404".to_owned(),
        }
    }
}

impl Page {
    /// Whether it is of the document that writes code.
    pub const fn is_out(self) -> bool {
        matches!(self, Self::Export(_) | Self::Project)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_page_has_its_address() {
        for page in [Page::Import, Page::Project, Page::Export(BlockId(7))] {
            assert_eq!(Page::read(&page.path()), page, "{page:?}");
        }
        assert_eq!(Page::read("/code/"), Page::Import);
        for path in ["/codex", "/code/x", "/code/b", "/code/d1", "/code/b1/x", "/cod", "/code/projects"] {
            assert_eq!(Page::read(path), Page::NotFound, "{path}");
        }
    }
}
