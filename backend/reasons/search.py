"""What is wrong with an area or a specification, what a search found, and what an import left out."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

SweepValue = Literal["bearing", "sigma", "quality", "altitude", "drift"]
Geometry = Literal["area", "fence", "no_fly", "confidence_region"]
_WHAT = "{what?area=The area|fence=The fence|no_fly=A no-fly zone|confidence_region=The confidence region}"


@dataclass(frozen=True, slots=True)
class AreaEmpty:
    what: Geometry
    code: Literal["area_empty"] = "area_empty"
    english: ClassVar[Words] = Words(_WHAT + " is empty.", "Draw at least three corners.")


@dataclass(frozen=True, slots=True)
class TooFewCorners:
    what: Geometry
    code: Literal["too_few_corners"] = "too_few_corners"
    english: ClassVar[Words] = Words(_WHAT + " has fewer than three different corners.", "Draw at least three.")


@dataclass(frozen=True, slots=True)
class TooManyCorners:
    what: Geometry
    most: int
    code: Literal["too_many_corners"] = "too_many_corners"
    english: ClassVar[Words] = Words(_WHAT + " has more than {most} corners.", "Simplify it.")


@dataclass(frozen=True, slots=True)
class OutlineUnusable:
    what: Geometry
    fault: Literal["crosses_itself", "hole_outside", "not_simple"]
    code: Literal["outline_unusable"] = "outline_unusable"
    english: ClassVar[Words] = Words(
        _WHAT + " {fault?crosses_itself=has an outline that crosses itself|hole_outside=has a hole outside its outline"
        "|not_simple=is not a simple polygon}.",
        "Move the corners so that no two edges cross.",
    )


@dataclass(frozen=True, slots=True)
class AreaTooSmall:
    area_m2: float
    least_m2: float
    code: Literal["area_too_small"] = "area_too_small"
    english: ClassVar[Words] = Words("The area has only {area_m2}.", "Draw at least {least_m2}.")


@dataclass(frozen=True, slots=True)
class AreaTooWide:
    width_m: float
    most_m: float
    code: Literal["area_too_wide"] = "area_too_wide"
    english: ClassVar[Words] = Words("The area is {width_m} wide.", "Search at most {most_m} at a time.")


@dataclass(frozen=True, slots=True)
class AreaTooFar:
    distance_m: float
    code: Literal["area_too_far"] = "area_too_far"
    english: ClassVar[Words] = Words(
        "The area is {distance_m} away from the vehicle.",
        "Draw the area where the vehicle is, or carry the vehicle there.",
    )


@dataclass(frozen=True, slots=True)
class HeadingsAskew:
    """All bearings of a source disagree with the others by about one angle, clockwise; nothing is claimed."""

    offset_deg: float
    std_error_deg: float
    code: Literal["headings_askew"] = "headings_askew"
    english: ClassVar[Words] = Words(
        "All bearings seem to be off by the same angle, about {offset_deg} ± {std_error_deg}: the place found may be "
        "wrong.",
        "Check compass and antenna mounting; a single wrong place can look the same.",
    )


@dataclass(frozen=True, slots=True)
class BearingsCorrected:
    """All bearings of a source are turned by one angle, clockwise; the belief has taken it off."""

    bias_deg: float
    std_error_deg: float
    code: Literal["bearings_corrected"] = "bearings_corrected"
    english: ClassVar[Words] = Words(
        "All bearings are turned by about {bias_deg} ± {std_error_deg}; the belief takes that into account.",
        "Check compass and antenna mounting before the next flight.",
    )


@dataclass(frozen=True, slots=True)
class BeliefBroke:
    """A fault of ours; the log has the traceback. Craft that wait for this belief hover on."""

    emitter_id: str
    code: Literal["belief_broke"] = "belief_broke"
    english: ClassVar[Words] = Words(
        "Updating the belief about {emitter_id} failed inside Crossfix: no next place is planned.",
        "Leave out the bearing that came last, or order the return.",
    )


@dataclass(frozen=True, slots=True)
class Localized:
    code: Literal["localized"] = "localized"
    english: ClassVar[Words] = Words("Localized: the expected error is within the goal.")


@dataclass(frozen=True, slots=True)
class LocalizedAgainst:
    """against: bearings that do not point at the place claimed; the claim stands against them (decision 12)."""

    against: int
    bearings: int
    code: Literal["localized_against"] = "localized_against"
    english: ClassVar[Words] = Words(
        "Localized: the expected error is within the goal; it stands against {against} of {bearings|bearing|bearings}."
    )


@dataclass(frozen=True, slots=True)
class RecordingTooLong:
    sweeps: int
    most: int
    code: Literal["recording_too_long"] = "recording_too_long"
    english: ClassVar[Words] = Words("The recording holds {sweeps} sweeps.", "Import at most {most} at once.")


@dataclass(frozen=True, slots=True)
class RecordingTooFar:
    distance_m: float
    code: Literal["recording_too_far"] = "recording_too_far"
    english: ClassVar[Words] = Words(
        "The recording was taken {distance_m} from the mission's area.",
        "Import it into a mission whose area is around it, or name the right place.",
    )


@dataclass(frozen=True, slots=True)
class PlaceTooFar:
    """Of a bearing that is reported, or where an emitter was found."""

    distance_m: float
    code: Literal["place_too_far"] = "place_too_far"
    english: ClassVar[Words] = Words(
        "The place is {distance_m} from the search's area.",
        "Check the place, or report it to the search that it belongs to.",
    )


@dataclass(frozen=True, slots=True)
class AskedFromTooFar:
    distance_m: float
    code: Literal["asked_from_too_far"] = "asked_from_too_far"
    english: ClassVar[Words] = Words(
        "You are {distance_m} from the search's area: too far to be advised where to listen.",
        "Go nearer, or say where you will be.",
    )


@dataclass(frozen=True, slots=True)
class HeardElsewhere:
    frequency_hz: float
    code: Literal["heard_elsewhere"] = "heard_elsewhere"
    english: ClassVar[Words] = Words(
        "The bearing was heard at {frequency_hz}, where nothing is looked for.",
        "Tune the station to a frequency of the search.",
    )


@dataclass(frozen=True, slots=True)
class KrakenUnreadable:
    """what: in English, for whoever set the station up."""

    what: str
    code: Literal["kraken_unreadable"] = "kraken_unreadable"
    english: ClassVar[Words] = Words(
        "This is no bearing of a KrakenSDR: {what}.",
        'Send the text of its DOA_value.html, written with the output format "Kraken App".',
    )


@dataclass(frozen=True, slots=True)
class BearingTimeImpossible:
    """age_s: negative of a time to come."""

    age_s: float
    code: Literal["bearing_time_impossible"] = "bearing_time_impossible"
    english: ClassVar[Words] = Words(
        "The bearing's time is in the future or more than a day ago.", "Set the clock of whatever sent it."
    )


@dataclass(frozen=True, slots=True)
class WhichEmitter:
    emitters: int
    code: Literal["which_emitter"] = "which_emitter"
    english: ClassVar[Words] = Words(
        "The search has {emitters} emitters, and none of them is named.", "Name the emitter."
    )


@dataclass(frozen=True, slots=True)
class TakenEarlier:
    """age_s: when it was brought in."""

    age_s: float
    code: Literal["taken_earlier"] = "taken_earlier"
    english: ClassVar[Words] = Words("It was taken {age_s} before it arrived.")


@dataclass(frozen=True, slots=True)
class ImportRemark:
    """What was changed about a recorded sweep when it was imported, or not changed about bearings."""

    file: str
    about: Literal["place_replaced", "altitude_unknown", "bearings_stand"]
    code: Literal["import_remark"] = "import_remark"
    english: ClassVar[Words] = Words(
        "{about?place_replaced=The place named replaces the one in"
        "|altitude_unknown=0 m AMSL is noted, as no altitude stands in"
        "|bearings_stand=The place or antenna named changes no bearing in} {file}."
    )


@dataclass(frozen=True, slots=True)
class OtherFrequency:
    file: str
    recorded_hz: float
    wanted_hz: float
    code: Literal["other_frequency"] = "other_frequency"
    english: ClassVar[Words] = Words(
        "The file {file} was recorded at {recorded_hz}; the mission looks for {wanted_hz}."
    )


@dataclass(frozen=True, slots=True)
class SweepIncomplete:
    """unknown: what of the sweep is not a number."""

    unknown: tuple[SweepValue, ...]
    code: Literal["sweep_incomplete"] = "sweep_incomplete"
    english: ClassVar[Words] = Words(
        "Of this sweep these values are unknown: "
        "{unknown?bearing=bearing|sigma=sigma|quality=quality|altitude=altitude|drift=drift}.",
        "Take the sweep again.",
    )


@dataclass(frozen=True, slots=True)
class QualityTooLow:
    """Cosine similarity of sweep and pattern, [0, 1]."""

    quality: float
    wanted: float
    code: Literal["quality_too_low"] = "quality_too_low"
    english: ClassVar[Words] = Words("The quality {quality:2} is below {wanted:2}.", "Take the sweep again.")


@dataclass(frozen=True, slots=True)
class UnheardForLong:
    """Of an emitter that would come first. places: in a row where it was not heard."""

    places: int
    code: Literal["unheard_for_long"] = "unheard_for_long"
    english: ClassVar[Words] = Words(
        "It was not heard from the last {places|place|places}; the others come first until it is heard.",
        "Set the order again to look for it first all the same.",
    )


@dataclass(frozen=True, slots=True)
class UnclearForLong:
    """Of an emitter that would come first. places: with a turn since its bearings contradict each other."""

    places: int
    code: Literal["unclear_for_long"] = "unclear_for_long"
    english: ClassVar[Words] = Words(
        "Its bearings have contradicted each other for {places|place|places}; the others come first until they agree.",
        "Look at its bearings and leave out a wrong one, or set the order again.",
    )


@dataclass(frozen=True, slots=True)
class FirstForLong:
    """Of an emitter that would come first. places: chosen for it first, without localizing it."""

    places: int
    code: Literal["first_for_long"] = "first_for_long"
    english: ClassVar[Words] = Words(
        "{places|place was|places were} chosen for it first and it is not localized; the others come first now.",
        "Set the order again to look for it first all the same.",
    )


@dataclass(frozen=True, slots=True)
class FrequencyShared:
    frequency_hz: float
    code: Literal["frequency_shared"] = "frequency_shared"
    english: ClassVar[Words] = Words(
        "Two emitters send at {frequency_hz}, and not both are tags: no receiver can tell them apart.",
        "Look for one of them at a time; tags at one frequency are distinguished by their periods.",
    )


@dataclass(frozen=True, slots=True)
class FrequenciesTooNear:
    """first_hz < second_hz: of two emitters. needed_hz: as far apart would do."""

    first_hz: float
    second_hz: float
    needed_hz: float
    code: Literal["frequencies_too_near"] = "frequencies_too_near"
    english: ClassVar[Words] = Words(
        "Emitters at {first_hz} and {second_hz} are so near to each other that the receiver hears each of them on both "
        "channels.",
        "From {needed_hz} on they are distinguished. Give tags nearer than that one frequency and their periods, and "
        "look for other emitters one at a time.",
    )


@dataclass(frozen=True, slots=True)
class TooManyRhythms:
    frequency_hz: float
    most: int
    code: Literal["too_many_rhythms"] = "too_many_rhythms"
    english: ClassVar[Words] = Words(
        "More than {most} tags send at {frequency_hz}: too many of their pulses fall together.",
        "Look for {most} of them at a time.",
    )


@dataclass(frozen=True, slots=True)
class RhythmsTooAlike:
    """needed_s: how far apart the two periods have to be."""

    frequency_hz: float
    first_s: float
    second_s: float
    needed_s: float
    code: Literal["rhythms_too_alike"] = "rhythms_too_alike"
    english: ClassVar[Words] = Words(
        "At {frequency_hz} one tag sends every {first_s:3} and another every {second_s:3}: their rhythms are too much "
        "alike.",
        "Tags that stray as much are distinguished when their periods differ by {needed_s:3} or more. Look for one of "
        "them at a time, or state a smaller jitter if theirs is.",
    )


SearchReason = (
    AreaEmpty
    | TooFewCorners
    | TooManyCorners
    | OutlineUnusable
    | AreaTooSmall
    | AreaTooWide
    | AreaTooFar
    | HeadingsAskew
    | BearingsCorrected
    | BeliefBroke
    | Localized
    | LocalizedAgainst
    | RecordingTooLong
    | RecordingTooFar
    | PlaceTooFar
    | AskedFromTooFar
    | HeardElsewhere
    | KrakenUnreadable
    | BearingTimeImpossible
    | WhichEmitter
    | TakenEarlier
    | ImportRemark
    | OtherFrequency
    | SweepIncomplete
    | QualityTooLow
    | UnheardForLong
    | UnclearForLong
    | FirstForLong
    | FrequencyShared
    | FrequenciesTooNear
    | TooManyRhythms
    | RhythmsTooAlike
)
