-- The names of the files of a project, without their ending, and members that only a newer version or another program
-- knows: JSON objects.
ALTER TABLE block ADD COLUMN file TEXT;

ALTER TABLE device ADD COLUMN file TEXT;
ALTER TABLE device ADD COLUMN extra TEXT NOT NULL DEFAULT '{}';

ALTER TABLE variable_group ADD COLUMN file TEXT;
ALTER TABLE variable_group ADD COLUMN extra TEXT NOT NULL DEFAULT '{}';

ALTER TABLE variable ADD COLUMN extra TEXT NOT NULL DEFAULT '{}';

-- What cipdeck.json says: at most one row.
CREATE TABLE project (
    id   INTEGER PRIMARY KEY CHECK (id = 1),
    head TEXT NOT NULL -- JSON
) STRICT;
