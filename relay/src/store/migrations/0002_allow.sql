-- What may be reached, and what operators may write; docs/SECURITY-MODEL.md.
CREATE TABLE allowed_target (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    target TEXT NOT NULL,
    note TEXT NOT NULL
) STRICT;

CREATE TABLE allowed_write (
    id INTEGER PRIMARY KEY AUTOINCREMENT,
    rule TEXT NOT NULL
) STRICT;
