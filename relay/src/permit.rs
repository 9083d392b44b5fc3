//! May this be sent? One function, [`permit`], answers: when a person gives a command, and again immediately before
//! each message is written. Users, write windows and allow-lists will be asked here as well.

use std::collections::BTreeMap;

use cipdeck_shared::config::BlockId;
use cipdeck_shared::table::Access;

/// What is known about each block when the question comes up.
#[derive(Debug, Default)]
pub(crate) struct Grants(BTreeMap<BlockId, Grant>);

#[derive(Debug, Default)]
struct Grant {
    /// The newest revision.
    current: u64,
    /// What each revision does that can still be under way; `None` for one with errors.
    accesses: BTreeMap<u64, Option<Access>>,
    /// The revision of the write that a person has seen and confirmed.
    confirmed: Option<u64>,
}

/// Why something must not be sent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub(crate) enum Denied {
    /// It was deleted, or never there.
    #[error("the block does not exist in this revision")]
    Unknown,
    /// Its configuration has errors: there is nothing that could be sent.
    #[error("the configuration has errors")]
    NoPlan,
    /// A write, and nobody has confirmed this revision.
    #[error(
        "this may write to the device: confirm it with \"confirm_write\": {revision}, the revision that you have seen"
    )]
    NotConfirmed {
        /// The revision that would be sent.
        revision: u64,
    },
}

/// Decides whether a message of this block and revision may be written.
pub(crate) fn permit(grants: &Grants, block: BlockId, revision: u64) -> Result<(), Denied> {
    let grant = grants.0.get(&block).ok_or(Denied::Unknown)?;
    let access = grant.accesses.get(&revision).ok_or(Denied::Unknown)?.ok_or(Denied::NoPlan)?;
    if access.may_write() && grant.confirmed != Some(revision) {
        return Err(Denied::NotConfirmed { revision });
    }
    Ok(())
}

impl Grants {
    /// A block is new or has changed. While it is busy its message goes on with the revision that it began with.
    pub(crate) fn put(&mut self, block: BlockId, revision: u64, access: Option<Access>, busy: bool) {
        let grant = self.0.entry(block).or_default();
        if !busy {
            grant.accesses.clear();
        }
        grant.accesses.insert(revision, access);
        grant.current = revision;
    }

    /// A block is gone.
    pub(crate) fn remove(&mut self, block: BlockId) {
        self.0.remove(&block);
    }

    /// A person gives a command that sends: `confirm` is the revision that they have seen, if they were asked. It
    /// holds until the next such command. Refused commands change nothing.
    pub(crate) fn command(&mut self, block: BlockId, confirm: Option<u64>) -> Result<(), Denied> {
        let grant = self.0.get_mut(&block).ok_or(Denied::Unknown)?;
        let (before, revision) = (grant.confirmed, grant.current);
        grant.confirmed = confirm;
        match permit(self, block, revision) {
            // Without a plan nothing is sent: the block itself says what is wrong.
            Ok(()) | Err(Denied::NoPlan) => Ok(()),
            Err(denied) => {
                if let Some(grant) = self.0.get_mut(&block) {
                    grant.confirmed = before;
                }
                Err(denied)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLOCK: BlockId = BlockId(7);

    fn grants(access: Option<Access>) -> Grants {
        let mut grants = Grants::default();
        grants.put(BLOCK, 3, access, false);
        grants
    }

    #[test]
    fn a_read_needs_no_confirmation() {
        let mut grants = grants(Some(Access::Read));
        assert_eq!(grants.command(BLOCK, None), Ok(()));
        assert_eq!(permit(&grants, BLOCK, 3), Ok(()));
    }

    #[test]
    fn what_may_write_needs_the_revision_that_a_person_has_seen() {
        for access in [Access::Write, Access::Unknown] {
            let mut grants = grants(Some(access));
            let denied = Err(Denied::NotConfirmed { revision: 3 });
            assert_eq!(permit(&grants, BLOCK, 3), denied);
            assert_eq!(grants.command(BLOCK, None), denied);
            assert_eq!(grants.command(BLOCK, Some(2)), denied);
            assert_eq!(grants.command(BLOCK, Some(3)), Ok(()));
            assert_eq!(permit(&grants, BLOCK, 3), Ok(()));
        }
    }

    #[test]
    fn a_refused_command_keeps_the_confirmation_and_the_next_command_replaces_it() {
        let mut grants = grants(Some(Access::Write));
        grants.command(BLOCK, Some(3)).unwrap();
        grants.command(BLOCK, None).unwrap_err();
        assert_eq!(permit(&grants, BLOCK, 3), Ok(()));
    }

    #[test]
    fn a_changed_write_is_to_be_confirmed_again_while_the_running_one_goes_on() {
        let mut grants = grants(Some(Access::Write));
        grants.command(BLOCK, Some(3)).unwrap();
        grants.put(BLOCK, 4, Some(Access::Write), true);
        assert_eq!(permit(&grants, BLOCK, 3), Ok(()));
        assert_eq!(permit(&grants, BLOCK, 4), Err(Denied::NotConfirmed { revision: 4 }));
        grants.put(BLOCK, 5, Some(Access::Read), false);
        assert_eq!(permit(&grants, BLOCK, 3), Err(Denied::Unknown));
    }

    #[test]
    fn nothing_is_sent_for_a_block_that_is_gone_or_has_errors() {
        let mut grants = grants(None);
        assert_eq!(permit(&grants, BLOCK, 3), Err(Denied::NoPlan));
        grants.remove(BLOCK);
        assert_eq!(permit(&grants, BLOCK, 3), Err(Denied::Unknown));
        assert_eq!(grants.command(BLOCK, Some(3)), Err(Denied::Unknown));
    }
}
