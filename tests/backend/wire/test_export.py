"""What other programs learn of several emitters and their order of importance."""

import json

from backend.wire.cot_export import cot_events
from backend.wire.export import bearings_csv, geojson, kml


def test_the_order_of_importance_stands_with_what_is_told_of_an_emitter(of_two_emitters, fox_first, tracks) -> None:
    before, after = (json.loads(geojson(told, tracks))["features"] for told in (of_two_emitters, fox_first))
    assert not any("priority" in one["properties"] for one in before)
    told = {one["properties"].get("emitter"): one["properties"].get("priority") for one in after}
    assert told == {None: None, "fox & <hound>": 1, "tag": None}
    kept = [one["properties"] for one in after]
    for properties in kept:
        properties.pop("priority", None)
    assert kept == [one["properties"] for one in before]
    assert '<Data name="priority"><value>1</value></Data>' in kml(fox_first, tracks)
    assert "priority" not in kml(of_two_emitters, tracks)
    remarks = [event.findtext("detail/remarks") or "" for event in cot_events(fox_first)]
    assert sum("priority 1" in text for text in remarks) == 1
    assert bearings_csv(fox_first, tracks) == bearings_csv(of_two_emitters, tracks), "numbers of tags stay"
