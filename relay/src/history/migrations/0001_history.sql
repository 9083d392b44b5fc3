-- Runs of one block lie together: one row for what has ended between two writes, not one for each run. That is what
-- makes history cheap, and small. The layout of "data" is that of chunk.rs; a change of it is a new table.
CREATE TABLE request (
    id    INTEGER PRIMARY KEY,
    bytes BLOB    NOT NULL UNIQUE, -- message router request
    used  INTEGER NOT NULL         -- a batch in which it was used, never long before the last one
) STRICT;

CREATE TABLE chunk (
    id       INTEGER PRIMARY KEY,
    batch    INTEGER NOT NULL, -- counts the writes; goes up with time even when the clock is put back
    block    INTEGER NOT NULL,
    request  INTEGER NOT NULL,
    first_us INTEGER NOT NULL, -- µs since 1970: the earliest and the latest end of a run in here
    last_us  INTEGER NOT NULL,
    runs     INTEGER NOT NULL,
    failed   INTEGER NOT NULL,
    data     BLOB    NOT NULL
) STRICT;

CREATE INDEX chunk_of_block ON chunk (block, batch, first_us, last_us);
CREATE INDEX chunk_of_batch ON chunk (batch, first_us, last_us);

CREATE TABLE total (runs INTEGER NOT NULL) STRICT;
INSERT INTO total VALUES (0);

CREATE TABLE dropped (
    id       INTEGER PRIMARY KEY,
    at_us    INTEGER NOT NULL, -- when it was noticed last
    why      TEXT    NOT NULL,
    runs     INTEGER,          -- NULL: nobody knows
    first_us INTEGER NOT NULL,
    last_us  INTEGER NOT NULL,
    detail   TEXT
) STRICT;
