-- Devices, their groups and variables. What belongs to something goes with it. AUTOINCREMENT: an id names one thing for
-- ever.
CREATE TABLE device (
    id       INTEGER PRIMARY KEY AUTOINCREMENT,
    revision INTEGER NOT NULL,
    config   TEXT    NOT NULL -- JSON, without id and revision
) STRICT;

CREATE TABLE variable_group (
    id       INTEGER PRIMARY KEY AUTOINCREMENT,
    device   INTEGER NOT NULL REFERENCES device (id) ON DELETE CASCADE,
    revision INTEGER NOT NULL,
    config   TEXT    NOT NULL
) STRICT;
CREATE INDEX group_of_device ON variable_group (device);

CREATE TABLE variable (
    id       INTEGER PRIMARY KEY AUTOINCREMENT,
    owner    INTEGER NOT NULL REFERENCES variable_group (id) ON DELETE CASCADE,
    revision INTEGER NOT NULL,
    config   TEXT    NOT NULL
) STRICT;
CREATE INDEX variable_of_group ON variable (owner);

-- The last writes of each device.
CREATE TABLE variable_write (
    id     INTEGER PRIMARY KEY AUTOINCREMENT,
    device INTEGER NOT NULL REFERENCES device (id) ON DELETE CASCADE,
    entry  TEXT    NOT NULL -- JSON
) STRICT;
CREATE INDEX write_of_device ON variable_write (device);
