"""Why a file from the field, or a part of one, cannot be used."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar, Literal

from planner.reason import Words

Quantity = Literal[
    "latitude",
    "longitude",
    "utm",
    "bearing",
    "sigma",
    "time",
    "heading",
    "power",
    "frequency",
    "snr",
    "attitude",
    "noise_psd",
    "kind_of_row",
]


@dataclass(frozen=True, slots=True)
class FileUnreadable:
    """detail: the operating system's or the format library's own words."""

    file: str
    detail: str
    code: Literal["file_unreadable"] = "file_unreadable"

    english: ClassVar[Words] = Words("The file {file} cannot be read ({detail}).", "Check its path and its format.")


@dataclass(frozen=True, slots=True)
class FileUnusable:
    file: str
    why: Literal["not_text", "empty", "no_pulse", "one_heading", "sweeps"]
    code: Literal["file_unusable"] = "file_unusable"

    english: ClassVar[Words] = Words(
        "The file {file} {why?not_text=is not a text file|empty=holds no rows of data|"
        "no_pulse=holds no pulse (no row that starts with 7)|"
        "one_heading=holds fewer than two rows of time and heading|sweeps=holds sweeps, no bearings}.",
        "{why?not_text=Export the recording as CSV|sweeps=Use crossfix sweep, or name no power|"
        "*=Check that it is the right file}.",
    )


@dataclass(frozen=True, slots=True)
class ColumnsUnknown:
    """line: the header's, or the first one's. expected: names of columns."""

    file: str
    line: int
    columns: int
    expected: tuple[str, ...]
    code: Literal["columns_unknown"] = "columns_unknown"

    english: ClassVar[Words] = Words(
        "The {columns|column|columns} of {file} (line {line}) cannot be told apart.",
        "Name them in a header line: {expected}.",
    )


@dataclass(frozen=True, slots=True)
class ColumnsAlike:
    """line: the header's. column, other: from 1. name, other_name: as they stand there."""

    file: str
    line: int
    column: int
    name: str
    other: int
    other_name: str
    code: Literal["columns_alike"] = "columns_alike"

    english: ClassVar[Words] = Words(
        'Columns {column} ("{name}") and {other} ("{other_name}") of {file} (line {line}) have the same name.',
        "Rename the one that is not meant.",
    )


@dataclass(frozen=True, slots=True)
class TooManyCells:
    """columns: those that the header names, or the two that a table without a header has. line: the first such row."""

    file: str
    line: int
    cells: int
    columns: int
    code: Literal["too_many_cells"] = "too_many_cells"

    english: ClassVar[Words] = Words(
        "Line {line} of {file} has {cells|cell|cells} for {columns|column|columns}.",
        "If numbers have decimal commas, separate columns with semicolons; else name every column in a header line.",
    )


@dataclass(frozen=True, slots=True)
class HeadingsInRadians:
    """column: from 1. least, most: of its values."""

    file: str
    column: int
    least: float
    most: float
    code: Literal["headings_in_radians"] = "headings_in_radians"

    english: ClassVar[Words] = Words(
        "The angles in column {column} of {file} ({least:2} to {most:2}) seem to be radians.",
        "Write degrees, and name the column heading_deg or bearing_deg.",
    )


@dataclass(frozen=True, slots=True)
class PowerLinear:
    """column: from 1. least, most: of its values. by: how one can tell."""

    file: str
    column: int
    by: Literal["name", "values"]
    least: float
    most: float
    code: Literal["power_linear"] = "power_linear"

    english: ClassVar[Words] = Words(
        "The power in column {column} of {file} ({least} to {most}) {by?name=is named as linear|"
        "values=seems to be linear}.",
        "Write decibels, and name the column power_db.",
    )


@dataclass(frozen=True, slots=True)
class CellUnusable:
    """A row that was left out. line, column: from 1. cell: as it stands there, empty when it does not."""

    file: str
    line: int
    column: int
    cell: str
    quantity: Quantity
    code: Literal["cell_unusable"] = "cell_unusable"

    english: ClassVar[Words] = Words(
        'Line {line} of {file} is left out: "{cell}" in column {column} is not a usable {quantity?'
        "kind_of_row=kind of row (7, 10 or 11)|snr=SNR|noise_psd=noise PSD|latitude=latitude|longitude=longitude|"
        "utm=UTM value (zone 22N, or 22 beside a column hemisphere)|"
        "bearing=bearing|sigma=sigma|time=time|heading=heading|power=power|frequency=frequency|attitude=attitude}."
    )


@dataclass(frozen=True, slots=True)
class RowLeftOut:
    file: str
    line: int
    why: Literal["columns", "not_open", "two_offsets", "wide"]
    code: Literal["row_left_out"] = "row_left_out"

    english: ClassVar[Words] = Words(
        "Line {line} of {file} is left out: {why?columns=it has too few columns|"
        "not_open=it ends a rotation that was never begun|"
        "two_offsets=columns 20 and 21 both carry an antenna offset|wide=it has more numbers than there are columns}.",
        "{why?two_offsets=Add a header line that names the right one.|"
        "wide=If numbers have decimal commas, separate columns with semicolons; else name every column in a header "
        "line.|*=}",
    )


@dataclass(frozen=True, slots=True)
class RotationIrregular:
    """line: of the row that begins it, or of the first row when none does."""

    file: str
    line: int
    why: Literal["empty", "not_closed", "offset_changes"]
    code: Literal["rotation_irregular"] = "rotation_irregular"

    english: ClassVar[Words] = Words(
        "The rotation from line {line} of {file} {why?empty=holds no usable pulse and is left out|"
        "not_closed=is never closed (no row 11); it ends where the next one begins, or with the file|"
        "offset_changes=changes its antenna offset; the commonest is used}."
    )


@dataclass(frozen=True, slots=True)
class PulsesOutsideRotations:
    file: str
    pulses: int
    code: Literal["pulses_outside_rotations"] = "pulses_outside_rotations"

    english: ClassVar[Words] = Words("Left out of {file}: {pulses|pulse|pulses} outside every rotation.")


@dataclass(frozen=True, slots=True)
class TagNotHeard:
    file: str
    line: int
    tag: str
    heard: tuple[str, ...]
    code: Literal["tag_not_heard"] = "tag_not_heard"

    english: ClassVar[Words] = Words(
        "Tag {tag} was not heard in the rotation from line {line} of {file}.", "Choose one of its tags: {heard}."
    )


@dataclass(frozen=True, slots=True)
class OtherTagsLeftOut:
    file: str
    line: int
    tag: str
    pulses: int
    others: tuple[str, ...]
    code: Literal["other_tags_left_out"] = "other_tags_left_out"

    english: ClassVar[Words] = Words(
        "Of the rotation from line {line} of {file}, tag {tag} is used, without {pulses|pulse|pulses} of other tags "
        "({others}).",
        "To use another tag, name it.",
    )


@dataclass(frozen=True, slots=True)
class DecibelsAssumed:
    """column: from 1. least, most: of its values."""

    file: str
    column: int
    least: float
    most: float
    code: Literal["decibels_assumed"] = "decibels_assumed"

    english: ClassVar[Words] = Words(
        "The power in column {column} of {file} ({least:2} to {most:2}) is taken for decibels.",
        "Name the column power_db if it is.",
    )


@dataclass(frozen=True, slots=True)
class FrequenciesUnread:
    """line, column: from 1, of the first one. cell: as it stands there."""

    file: str
    line: int
    column: int
    cell: str
    code: Literal["frequencies_unread"] = "frequencies_unread"

    english: ClassVar[Words] = Words(
        'No frequency in column {column} of {file} can be read, as "{cell}" in line {line}.',
        "Write each as one number, and the unit behind it or in the column's name.",
    )


@dataclass(frozen=True, slots=True)
class PlacesApart:
    """line: of the sweep's first row. apart_m: of its row that is farthest from the place that it counts from."""

    file: str
    line: int
    apart_m: float
    code: Literal["places_apart"] = "places_apart"

    english: ClassVar[Words] = Words(
        "The sweep from line {line} of {file} was taken at places {apart_m} apart.",
        "Number several turns in a column named sweep.",
    )


TableRemark = (
    CellUnusable
    | RowLeftOut
    | RotationIrregular
    | PulsesOutsideRotations
    | TagNotHeard
    | OtherTagsLeftOut
    | DecibelsAssumed
    | FrequenciesUnread
    | PlacesApart
)
"""What is left out of a file, or assumed in it."""


@dataclass(frozen=True, slots=True)
class NothingUsable:
    """because: what was wrong first."""

    file: str
    wanted: Literal["bearing", "power", "pulse"]
    because: TableRemark
    code: Literal["nothing_usable"] = "nothing_usable"

    english: ClassVar[Words] = Words(
        "The file {file} holds no usable {wanted?bearing=bearing|power=row of heading and power|pulse=pulse}. "
        "{because}",
        "{wanted?bearing=Name the columns lat, lon, bearing_deg and, if known, sigma_deg.|"
        "power=Name the columns heading_deg and power_db.|pulse=Check that it is the right file.}",
    )


@dataclass(frozen=True, slots=True)
class OneTagOnly:
    """tags: those of which the file holds bearings."""

    file: str
    tags: tuple[str, ...]
    code: Literal["one_tag_only"] = "one_tag_only"

    english: ClassVar[Words] = Words("{file} holds bearings of the tags {tags}.", "Name one of them.")


@dataclass(frozen=True, slots=True)
class PlaceNotStated:
    file: str
    code: Literal["place_not_stated"] = "place_not_stated"

    english: ClassVar[Words] = Words(
        "The file {file} does not state where it was recorded.", "Add columns lat and lon, or name the place beside it."
    )


@dataclass(frozen=True, slots=True)
class RemarksNotListed:
    """Of a file of which too much was left out to be told one by one."""

    file: str
    remarks: int
    code: Literal["remarks_not_listed"] = "remarks_not_listed"

    english: ClassVar[Words] = Words("{remarks|more remark|more remarks} about {file}: not listed one by one.")


TableReason = (
    FileUnreadable
    | FileUnusable
    | ColumnsUnknown
    | ColumnsAlike
    | TooManyCells
    | HeadingsInRadians
    | PowerLinear
    | TableRemark
    | NothingUsable
    | OneTagOnly
    | PlaceNotStated
    | RemarksNotListed
)
