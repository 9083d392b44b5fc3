"""Archives for schemathesis, which asks `POST /api/v1/project` with them: good ones, and some that are not."""

import io
import json
import zipfile

import schemathesis
from hypothesis import strategies as st

NAMES = st.sampled_from(["one", "two", "Förderband 3"])


@st.composite
def blocks(draw, services):
    """Files with blocks."""
    made = {}
    for place, service in enumerate(draw(st.lists(services, min_size=1, max_size=3))):
        request = {"Service": service, "Class": 1, "Instance": 1, "Attribute": draw(st.integers(1, 7))}
        block = {"name": draw(NAMES), "AppCfg": request, "TargetCfg": {"Path": "0,0"}}
        made[f"blocks/{place}.json"] = json.dumps(block)
    return made


@st.composite
def archive(draw, files, heads=st.just(1)):
    """Files beside the head of a project."""
    head = {"project": draw(heads), "name": draw(NAMES)}
    method = draw(st.sampled_from([zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED]))
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", method) as out:
        for path, text in {"cipdeck.json": json.dumps(head), **draw(files)}.items():
            out.writestr(path, text)
    return packed.getvalue()


GOOD = archive(blocks(st.sampled_from([14, 1])))
# Numbers that no block has, a version that is not known yet, files that are not JSON or in the wrong place.
PATHS = st.sampled_from(["blocks/x.json", "groups/a/b.json", "targets/x.json", "README.md"])
WRONG = st.one_of(
    archive(blocks(st.sampled_from([0, 300]))),
    archive(st.just({}), st.integers(2, 9)),
    archive(st.dictionaries(PATHS, st.sampled_from(["{", "[]", "{}"]), min_size=1)),
)
# Paths that lead out, and archives that are cut off.
UNREADABLE = st.one_of(
    archive(st.just({"../x.json": "{}"})),
    st.builds(lambda whole, at: whole[: at % len(whole)], GOOD, st.integers(0, 1000)),
)

schemathesis.openapi.media_type("application/zip", st.one_of(GOOD, GOOD, WRONG, UNREADABLE))
