"""What is wrong with a request, or with the server that got it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

NothingKind = Literal[
    "terrain",
    "mission",
    "page",
    "belief_about",
    "belief_at",
    "belief_after",
    "sweep",
    "map",
    "overlay",
    "file",
    "recording",
    "craft",
    "scene",
    "person",
    "session",
    "invitation",
    "token",
]


@dataclass(frozen=True, slots=True)
class FieldMissing:
    code: Literal["field_missing"] = "field_missing"
    english: ClassVar[Words] = Words("It is missing.")


@dataclass(frozen=True, slots=True)
class FieldUnknown:
    code: Literal["field_unknown"] = "field_unknown"
    english: ClassVar[Words] = Words("There is no such field.")


@dataclass(frozen=True, slots=True)
class FieldOutOfRange:
    """bound: what it is compared with."""

    relation: Literal["greater_than", "greater_than_equal", "less_than", "less_than_equal"]
    bound: float
    code: Literal["field_out_of_range"] = "field_out_of_range"
    english: ClassVar[Words] = Words(
        "It must be {relation?greater_than=greater than|greater_than_equal=at least|less_than=less than"
        "|less_than_equal=at most} {bound}."
    )


@dataclass(frozen=True, slots=True)
class FieldWrongLength:
    """Of a text (characters) or a list (items)."""

    relation: Literal["least", "most"]
    length: int
    code: Literal["field_wrong_length"] = "field_wrong_length"
    english: ClassVar[Words] = Words("It must have {relation?least=at least|most=at most} {length|item|items}.")


@dataclass(frozen=True, slots=True)
class FieldNotOneOf:
    """expected: the values there are, as pydantic lists them."""

    expected: str
    code: Literal["field_not_one_of"] = "field_not_one_of"
    english: ClassVar[Words] = Words("It must be one of {expected}.")


@dataclass(frozen=True, slots=True)
class FieldInvalid:
    """message: of the validator, in English."""

    message: str
    code: Literal["field_invalid"] = "field_invalid"
    english: ClassVar[Words] = Words("It is not valid: {message}.")


@dataclass(frozen=True, slots=True)
class RequestInvalid:
    """field: path into the request of the first fault, empty for the whole. faults: how many there are."""

    field: str
    faults: int
    code: Literal["request_invalid"] = "request_invalid"
    english: ClassVar[Words] = Words(
        "The request is not valid: {faults|field is|fields are} wrong, first {field}.",
        "Correct the named fields and send it again.",
    )


@dataclass(frozen=True, slots=True)
class NothingThere:
    """which: its name or id; of a belief the emitter, or the number of the event or of the bearings."""

    what: NothingKind
    which: str
    code: Literal["nothing_there"] = "nothing_there"
    english: ClassVar[Words] = Words(
        "There is no {what?mission=mission|page=page|belief_about=belief about|belief_at=belief at the event"
        "|belief_after=belief after this many bearings:|sweep=sweep|map=map|overlay=overlay|terrain=terrain|file=file"
        "|recording=recording|craft=craft|scene=3D view|person=person|session=session|invitation=invitation"
        "|token=token} {which}.",
        "It may have been removed, or its name has a mistake in it: look at what there is and choose again.",
    )


@dataclass(frozen=True, slots=True)
class IqNotKept:
    code: Literal["iq_not_kept"] = "iq_not_kept"
    english: ClassVar[Words] = Words(
        "No IQ was kept of this mission, only the power of its sweeps.",
        "IQ is kept of SigMF recordings that are imported; export everything for the power, sample by sample.",
    )


@dataclass(frozen=True, slots=True)
class HttpRefused:
    """phrase: the status in words, in English."""

    status: int
    phrase: str
    code: Literal["http_refused"] = "http_refused"
    english: ClassVar[Words] = Words("The request was refused ({status}): {phrase}.")


@dataclass(frozen=True, slots=True)
class BodyTooLarge:
    """what: was sent: the file of a mission, or anything else."""

    most_bytes: int
    what: Literal["mission", "other"]
    code: Literal["body_too_large"] = "body_too_large"
    english: ClassVar[Words] = Words(
        "{what?mission=The file of a mission|other=A request} may have at most {most_bytes}.",
        "{what?mission=Choose the zip file that “All of it” saves under “Take away”: it is packed. If this is it, "
        "the mission is longer than any that can be read.|other=Simplify the geometry, or split the file.}",
    )


@dataclass(frozen=True, slots=True)
class BodyTooRich:
    most_fields: int
    most_items: int
    code: Literal["body_too_rich"] = "body_too_rich"
    english: ClassVar[Words] = Words(
        "A request may have at most {most_fields} named fields and {most_items} items in its lists.",
        "Simplify the geometry.",
    )


@dataclass(frozen=True, slots=True)
class BodyTooSlow:
    """wait_s: how long nothing arrived."""

    wait_s: float
    code: Literal["body_too_slow"] = "body_too_slow"
    english: ClassVar[Words] = Words(
        "Nothing of the request arrived for {wait_s}.", "Look at the network, then send it again."
    )


@dataclass(frozen=True, slots=True)
class UnknownHost:
    host: str
    code: Literal["unknown_host"] = "unknown_host"
    english: ClassVar[Words] = Words(
        "This server does not go by the name {host}.",
        "Open it by its IP address or localhost, or name the host in CROSSFIX_ALLOWED_HOSTS.",
    )


@dataclass(frozen=True, slots=True)
class ForeignOrigin:
    origin: str
    code: Literal["foreign_origin"] = "foreign_origin"
    english: ClassVar[Words] = Words(
        "A page of {origin} may not command this server.", "Use the page that this server serves."
    )


@dataclass(frozen=True, slots=True)
class SamplesNotStored:
    place_number: int
    code: Literal["samples_not_stored"] = "samples_not_stored"
    english: ClassVar[Words] = Words(
        "The power samples of place {place_number} were not stored, so no other antenna can hear them.",
        "Ask with another bearing error, share of wrong bearings or planner: these need no samples.",
    )


@dataclass(frozen=True, slots=True)
class HalfGiven:
    """Two fields that go together, of which one is missing."""

    pair: Literal["place", "pulses"]
    code: Literal["half_given"] = "half_given"
    english: ClassVar[Words] = Words(
        "{pair?place=A place needs both latitude and longitude|pulses=A pulsed tag needs both its pulse width and its "
        "period}.",
        "Give both, or neither.",
    )


@dataclass(frozen=True, slots=True)
class TooManyFiles:
    files: int
    code: Literal["too_many_files"] = "too_many_files"
    english: ClassVar[Words] = Words(
        "{files|file is|files are} more than one recording.", "Upload one file, or meta, data and headings."
    )


@dataclass(frozen=True, slots=True)
class TwoRecordings:
    first: str
    second: str
    code: Literal["two_recordings"] = "two_recordings"
    english: ClassVar[Words] = Words(
        "The files {first} and {second} are two recordings.", "Upload them one after the other."
    )


@dataclass(frozen=True, slots=True)
class ExportUnreadable:
    """What was sent cannot be read as an exported mission. later: a later Crossfix exported it."""

    fault: Literal["not_json", "not_exported", "later"]
    code: Literal["export_unreadable"] = "export_unreadable"
    english: ClassVar[Words] = Words(
        "This {fault?not_json=is not JSON|not_exported=is not a mission that Crossfix exported"
        "|later=was exported by a later Crossfix}.",
        "{fault?later=Open it with that Crossfix.|*=Choose the file mission.json of an export.}",
    )


@dataclass(frozen=True, slots=True)
class BundleUnreadable:
    """What was sent cannot be brought in as a mission."""

    fault: Literal["not_zip", "too_large", "later", "under_way", "differs"]
    code: Literal["bundle_unreadable"] = "bundle_unreadable"
    english: ClassVar[Words] = Words(
        "{fault?not_zip=This is not a zip file"
        "|too_large=The files in the bundle are larger than those of any mission"
        "|later=A later Crossfix wrote this bundle"
        "|under_way=The mission was still under way when the bundle was written"
        "|differs=This installation has the same mission with other facts}.",
        "{fault?later=Open it with that Crossfix."
        "|under_way=Export it again after it has ended."
        "|differs=Nothing was changed. Open the mission that is here."
        "|*=Choose the zip file that “All of it” saves under “Take away”, unchanged.}",
    )


@dataclass(frozen=True, slots=True)
class BundleFileWrong:
    """name: of the file in the bundle that cannot be brought in, and the whole bundle with it."""

    fault: Literal["foreign", "damaged", "not_exported"]
    name: str
    code: Literal["bundle_file_wrong"] = "bundle_file_wrong"
    english: ClassVar[Words] = Words(
        "{fault?foreign=Crossfix writes no such file into a bundle|damaged=A file in the bundle is damaged"
        "|not_exported=A file in the bundle is not one that Crossfix exported}: {name}.",
        "Choose the zip file that “All of it” saves under “Take away”, unchanged.",
    )


FactFault = Literal["place", "region", "spread", "unknown_bearing", "bearing_twice", "not_started", "name", "id"]


@dataclass(frozen=True, slots=True)
class BundleFactWrong:
    """seq: of the fact in the mission of a bundle that no Crossfix recorded; the whole bundle is not brought in."""

    fault: FactFault
    seq: int
    code: Literal["bundle_fact_wrong"] = "bundle_fact_wrong"
    english: ClassVar[Words] = Words(
        "Event {seq} in the bundle’s mission.json {fault?place=tells an estimate that is no place on Earth"
        "|region=tells a 95 % region that is no area|spread=tells an uncertainty or a number that cannot be"
        "|unknown_bearing=leaves out, or takes in again, a bearing that there is not"
        "|bearing_twice=tells a bearing whose id another one has"
        "|not_started=tells of a craft that had not started"
        "|name=gives a name whose characters turn the direction of writing"
        "|id=names a sweep with characters that no id has}.",
        "Nothing was brought in. Choose the zip file that “All of it” saves under “Take away”, unchanged.",
    )


@dataclass(frozen=True, slots=True)
class UploadBrokeOff:
    code: Literal["upload_broke_off"] = "upload_broke_off"
    english: ClassVar[Words] = Words("The upload broke off; nothing was kept.", "Upload the file again.")


@dataclass(frozen=True, slots=True)
class NoPayloadExpected:
    code: Literal["no_payload_expected"] = "no_payload_expected"
    english: ClassVar[Words] = Words(
        "This server takes no samples from a payload.",
        "Start it with CROSSFIX_PAYLOAD_TOKENS, a list of the tokens its payloads may show.",
    )


@dataclass(frozen=True, slots=True)
class UnknownToken:
    code: Literal["unknown_token"] = "unknown_token"
    english: ClassVar[Words] = Words(
        "The server does not know this token, or it lasts no longer.",
        "Ask an admin for a new one, or take one of those in CROSSFIX_PAYLOAD_TOKENS for a payload.",
    )


@dataclass(frozen=True, slots=True)
class TooManyScenes:
    code: Literal["too_many_scenes"] = "too_many_scenes"
    english: ClassVar[Words] = Words("Too many 3D views are open.", "Close one in another tab.")


@dataclass(frozen=True, slots=True)
class SceneSilent:
    code: Literal["scene_silent"] = "scene_silent"
    english: ClassVar[Words] = Words("The 3D server does not answer.", "Load the view again.")


@dataclass(frozen=True, slots=True)
class ServerBroke:
    """incident: the same id is in the server's log."""

    incident: str
    code: Literal["server_broke"] = "server_broke"
    english: ClassVar[Words] = Words(
        "The request could not be carried out because of a fault in the server (incident {incident}).",
        "The mission goes on. Try again; if it happens again, report the incident with the server's log.",
    )


RequestReason = (
    FieldMissing
    | FieldUnknown
    | FieldOutOfRange
    | FieldWrongLength
    | FieldNotOneOf
    | FieldInvalid
    | RequestInvalid
    | NothingThere
    | IqNotKept
    | HttpRefused
    | BodyTooLarge
    | BodyTooRich
    | BodyTooSlow
    | UnknownHost
    | ForeignOrigin
    | SamplesNotStored
    | HalfGiven
    | TooManyFiles
    | TwoRecordings
    | ExportUnreadable
    | BundleUnreadable
    | BundleFileWrong
    | BundleFactWrong
    | UploadBrokeOff
    | NoPayloadExpected
    | UnknownToken
    | TooManyScenes
    | SceneSilent
    | ServerBroke
)
