-- AUTOINCREMENT: an id is never used again, not even after its block was deleted and the relay restarted.
CREATE TABLE block (
    id       INTEGER PRIMARY KEY AUTOINCREMENT,
    revision INTEGER NOT NULL,
    config   TEXT    NOT NULL, -- JSON, without id and revision
    input    INTEGER NOT NULL DEFAULT 0 -- the last state of IN, for blocks that resume
) STRICT;
