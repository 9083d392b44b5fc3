CREATE TABLE user (
    name         TEXT    PRIMARY KEY,
    role         TEXT    NOT NULL, -- viewer, operator, engineer, admin
    disabled     INTEGER NOT NULL DEFAULT 0,
    password     TEXT    NOT NULL, -- Argon2id, as a PHC string
    created_at   TEXT    NOT NULL, -- RFC 3339
    last_sign_in TEXT
) STRICT;

-- API tokens and view links. AUTOINCREMENT: an id names one pass for ever.
CREATE TABLE pass (
    id         INTEGER PRIMARY KEY AUTOINCREMENT,
    kind       TEXT    NOT NULL, -- token, view_link
    name       TEXT    NOT NULL,
    role       TEXT    NOT NULL,
    scope      TEXT    NOT NULL, -- one target a line
    digest     BLOB    NOT NULL UNIQUE, -- SHA-256 of the secret
    created_by TEXT    NOT NULL,
    ends_at    INTEGER NOT NULL, -- s since 1970
    last_used  INTEGER -- the same; not exact
) STRICT;
