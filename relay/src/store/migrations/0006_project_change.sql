-- The last change of several files of the project that was stored whole: after a power failure in the middle of one, it
-- says on which side of it the database is.
ALTER TABLE project ADD COLUMN change TEXT;
