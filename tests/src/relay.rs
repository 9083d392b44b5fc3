//! A relay in this process, on a free port, with its data in a temporary folder.
