"""Settings of one server: environment variables CROSSFIX_*, or what the command line passes. Units in the names."""

from __future__ import annotations

import re
from collections.abc import Mapping
from ipaddress import ip_address
from pathlib import Path
from typing import Annotated, Any, Literal
from urllib.parse import quote, unquote, urlsplit

from pydantic import Field, ValidationError, field_validator, model_validator
from pydantic_settings import BaseSettings, SettingsConfigDict

REPOSITORY = Path(__file__).resolve().parent.parent
BUILT_PAGE, INSTALLED_PAGE = REPOSITORY / "frontend" / "dist", Path(__file__).resolve().parent / "page"
"""Where `make build` puts the page, and where a wheel has it."""
DATABASE_PORT = re.compile(r"[\w+]+://(?:[^:/]*(?::[^@]*)?@)?(?:\[[^/?]+\]|[^/:?]+)?(?::([^/?]*))?")
"""As SQLAlchemy reads a URL."""
AUDIT_FILE = "audit.jsonl"
"""Who did what, in the data directory."""


class Settings(BaseSettings):
    """`vehicle_url` None: a simulated vehicle of flavour `simulate`. `database_url` None: SQLite in `data_dir`."""

    model_config = SettingsConfigDict(env_prefix="CROSSFIX_", frozen=True, extra="forbid")

    host: str = "127.0.0.1"
    port: int = Field(default=8600, ge=0, le=65535)
    allowed_hosts: tuple[str, ...] = ()
    """Host names besides loopback under which a browser may reach the server."""
    public_url: str | None = None
    """Where people open the page when that is not where the server listens, as behind a proxy: for links it prints."""
    users: bool = False
    """People sign in, though the server listens to this machine only: behind a proxy on the same machine."""
    trusted_proxies: tuple[str, ...] = ()
    """Addresses of the proxies whose word counts on who asks and whether by https (X-Forwarded-For, -Proto). With one,
    people sign in."""
    plain_http: bool = False
    """Passwords and sessions may go over unencrypted connections from other machines. Only for a network that encrypts
    by itself, such as WireGuard."""
    oidc_issuer: str | None = None
    """Address of an OpenID Connect provider that people may sign in with; with one, people sign in."""
    oidc_client_id: str = ""
    oidc_client_secret_file: Path | None = None
    """Its content is the secret; None: the provider knows this server as a public client."""
    oidc_name: str = Field(default="", max_length=40)
    """Of the provider, on the page; its host's name by default."""
    oidc_role_claim: str | None = None
    """The claim of the ID token that holds groups or roles; one inside another by a dot: realm_access.roles."""
    oidc_roles: dict[str, Literal["viewer", "operator", "pilot", "admin"]] = Field(default_factory=dict)
    """Value of that claim -> role here; admin: manages people. Values that are missing here give nothing."""
    oidc_default_role: Literal["viewer", "operator", "pilot", "none"] = "viewer"
    """Of whoever has no such value; none: they do not enter."""
    oidc_email_domains: tuple[str, ...] = ()
    """When there are any, only verified addresses in one of them enter: for providers where anybody has an account."""
    connections_max: int = Field(default=2000, ge=10, le=100_000)
    """Of HTTP, open at the same time, as far as the system allows; live websockets are counted by live_clients_max."""
    connections_each: int = Field(default=100, ge=5, le=100_000)
    """Of one address, but for this machine's and the trusted proxies'."""
    header_timeout_s: float = Field(default=10.0, gt=0, le=300)
    """A connection that has not sent a whole request's head by then is closed."""
    data_dir: Path = Path("data")
    page_dir: Path = INSTALLED_PAGE if INSTALLED_PAGE.is_dir() else BUILT_PAGE

    database_url: str | None = None
    database_password_file: Path | None = None
    """Its content is the password, so that it stands in no environment and no list of processes."""
    database_timeout_s: Annotated[float, Field(gt=0, le=60)] = 2.0
    """An append that takes longer goes to the spool."""
    database_slow_s: Annotated[float, Field(gt=0, le=60)] = 0.5
    spool_reserve_bytes: int = Field(default=16 * 2**20, ge=64 * 2**10, le=2**32 - 1)
    """Disk blocks taken in advance, so that a full disk does not stop the journal."""
    disk_low_bytes: int = Field(default=200 * 2**20, ge=0)

    keep_sweeps_days: Annotated[float, Field(ge=0, le=36_500)] | None = None
    """Raw sweeps of missions that ended longer ago are taken, once the server has also run on thirty days since it
    found them so (on as many as this says, where that is fewer): its clock may be wrong. None: kept for ever."""

    overlays_max: int = Field(default=200, ge=0)
    overlays_max_bytes: int = Field(default=500 * 10**6, ge=0)
    """Of all overlays together, as they are stored; maps and terrain may fill the disk up to disk_low_bytes."""
    recordings_max_sweeps: int = Field(default=20_000, ge=0)
    recordings_max_bytes: int = Field(default=2 * 10**9, ge=0)
    """Of the raw sweeps of all imported recordings together, as they are stored."""
    iq_max_bytes: int = Field(default=2 * 10**9, ge=0)
    """Of the IQ of all imported SigMF recordings together; what finds no room is not kept. 0: none is."""

    payload_tokens: tuple[str, ...] = ()
    """What payload agents show to be let in; a JSON list in the environment. None: no payload may connect."""

    log_level: Literal["debug", "info", "warning", "error"] = "warning"
    """Of what goes to the standard error; the file has everything from info on."""
    log_format: Literal["text", "json"] = "text"
    log_file: Path | None = None
    log_file_bytes: int = Field(default=10 * 2**20, ge=2**16)
    """A file of this size is put away, and `log_files_kept` of those are kept."""
    log_files_kept: int = Field(default=9, ge=0, le=1000)

    receiver: str | None = None
    """"simulated", "payload", or a device: soapy:driver=NAME, rtl_tcp://HOST[:PORT], sigmf:FILE, recording:FILE. None:
    the payload's when payloads may connect, else the simulated one."""
    bearings_udp_port: int | None = Field(default=None, ge=0, le=65535)
    """Where bearings arrive as UDP datagrams (JSON, type BEARING), for the search that flies. None: nowhere."""
    bearings_udp_host: str = "127.0.0.1"
    """Nobody signs in on UDP: beyond this machine, whoever reaches the port can add bearings."""
    antenna_pattern: Path | None = None
    """JSON pattern or turntable table of the antenna; None: the small Yagi that ships."""
    heading_sigma_deg: float = Field(default=4.0, ge=0, le=45, allow_inf_nan=False)
    """What the vehicle's heading is uncertain by; stated with every bearing besides the sweep's own sigma."""

    vehicle_url: str | None = None
    simulate: Literal["px4", "ardupilot"] = "px4"
    simulated_flies_on: bool = True
    """A server that is killed leaves its simulated vehicle in the air, as a real one would stay; the next finds it."""
    world: Literal["open", "multipath"] = "open"
    """The simulated emitter's surroundings: open ground, or walls that reflect, so that some bearings are wrong."""
    emitters: tuple[str, ...] = ()
    """Simulated emitters besides those of the presets: MHZ, MHZ/PULSE_PERIOD_S, and ,GAIT:SPEED behind either; a JSON
    list in the environment."""
    simulated_band_hz: float | None = Field(default=None, ge=5_000, le=1e9, allow_inf_nan=False)
    """How wide a band the simulated receiver hears at once; without it, any."""
    time_factor: float = Field(default=1.0, gt=0, le=1000, allow_inf_nan=False)
    seed: int = Field(default=1, ge=0, le=2**31 - 1)
    home_lat_deg: float = Field(default=50.6234, ge=-80, le=80, allow_inf_nan=False)
    home_lon_deg: float = Field(default=7.2046, ge=-180, le=180, allow_inf_nan=False)
    """Home of the simulated vehicle, and where a suggested area lies while no vehicle was heard."""

    live_ping_interval_s: float = Field(default=3.0, gt=0, le=60)
    live_ping_timeout_s: float = Field(default=6.0, gt=0, le=60)
    live_clients_max: int = Field(default=500, ge=1, le=10_000)
    """More browsers are refused; each costs at most its socket's buffer."""

    @field_validator("database_url")
    @classmethod
    def known_database(cls, url: str | None) -> str | None:
        """By the URL's scheme; whether it answers shows when the journal is opened."""
        if url is None:
            return None
        if not url.startswith(("sqlite:", "postgresql:", "postgres:", "sqlite+", "postgresql+")):
            raise ValueError("the database URL must begin with sqlite:/// or postgresql://")
        port = DATABASE_PORT.match(url)
        if port and port[1] and not (port[1].isdecimal() and 0 < int(port[1]) < 2**16):  # not shown: a password may be
            raise ValueError("the database URL's port must be a number from 1 to 65535 (write @ in a password as %40)")
        return url

    @field_validator("public_url")
    @classmethod
    def address_of_the_page(cls, url: str | None) -> str | None:
        """What a link can be made of by adding to it, without the port that goes without saying; "" is None."""
        if not url:
            return None
        parts = urlsplit(url)
        if parts.scheme in {"http", "https"} and parts.hostname and not (parts.query or parts.fragment or "@" in url):
            usual = ":443" if parts.scheme == "https" else ":80"
            return parts._replace(netloc=parts.netloc.removesuffix(usual)).geturl().rstrip("/")
        raise ValueError("the page's public address must begin with https:// and name a host, and nothing behind it")

    @field_validator("oidc_issuer")
    @classmethod
    def encrypted_issuer(cls, issuer: str | None) -> str | None:
        """By https, but for one on this machine, which only tests have."""
        if issuer is None:
            return None
        parts = urlsplit(issuer)
        if (parts.scheme == "https" and parts.hostname) or parts.hostname in {"127.0.0.1", "localhost"}:
            return issuer
        raise ValueError("the sign-in provider's address must begin with https://")

    @model_validator(mode="after")
    def whole_provider(self) -> Settings:
        """A provider knows this server by an id; a claim without roles, or roles without a claim, give nothing."""
        if self.oidc_issuer is not None and not self.oidc_client_id:
            raise ValueError("CROSSFIX_OIDC_CLIENT_ID is missing: the provider gives it when this server is registered")
        if bool(self.oidc_roles) != bool(self.oidc_role_claim):
            raise ValueError("CROSSFIX_OIDC_ROLE_CLAIM and CROSSFIX_OIDC_ROLES work only together: set both or neither")
        return self

    @property
    def oidc_client_secret(self) -> str | None:
        """Raises ValueError when its file cannot be read."""
        if self.oidc_client_secret_file is None:
            return None
        try:
            return self.oidc_client_secret_file.read_text().strip()
        except (OSError, UnicodeDecodeError) as error:
            raise ValueError(f"the sign-in provider's secret cannot be read: {error}") from error

    @property
    def reachable_from_outside(self) -> bool:
        """Does the server listen on more than this machine's loopback?"""
        try:
            return not ip_address(self.host).is_loopback
        except ValueError:
            return self.host != "localhost"

    @property
    def names(self) -> tuple[str, ...]:
        """Host names besides localhost under which a browser may reach the server: a link that it prints works."""
        public = None if self.public_url is None else urlsplit(self.public_url).hostname
        return (self.host, *self.allowed_hosts, *(() if public is None else (public,)))

    @property
    def people_expected(self) -> bool:
        """Others can reach the server, so whoever uses it signs in."""
        return self.users or bool(self.trusted_proxies) or self.oidc_issuer is not None or self.reachable_from_outside

    @property
    def simulated(self) -> bool:
        """Without a vehicle's URL the vehicle, and the world that its receiver hears, are simulated."""
        return self.vehicle_url is None

    @property
    def async_database_url(self) -> str:
        """With the driver that is used: aiosqlite or asyncpg."""
        url = self.database_url or f"sqlite:///{(self.data_dir / 'crossfix.sqlite').resolve()}"
        if self.database_password_file is not None:
            url = _with_password(url, self.database_password_file)
        scheme, rest = url.split(":", 1)
        driver = "sqlite+aiosqlite" if scheme.startswith("sqlite") else "postgresql+asyncpg"
        return f"{driver}:{rest}"

    @property
    def shown_database(self) -> str:
        """Its URL without user and password, for people and logs; nor its query, which may hold them as well."""
        from sqlalchemy import URL, make_url  # a sixth of a second, which commands without a database are spared
        from sqlalchemy.exc import ArgumentError

        try:
            url = make_url(self.async_database_url)
        except (ArgumentError, ValueError):
            return self.async_database_url.partition(":")[0]
        shown = URL.create(url.drivername, host=url.host, port=url.port, database=url.database)
        return unquote(shown.render_as_string())

    @property
    def spool_path(self) -> Path:
        """Where facts wait while the database is away."""
        return self.data_dir / "journal.spool"


def _with_password(url: str, file: Path) -> str:
    """Raises ValueError when the file cannot be read."""
    try:
        password = file.read_text().strip()
    except (OSError, UnicodeDecodeError) as error:
        raise ValueError(f"the database's password cannot be read from {file}: {error}") from error
    user, found, rest = url.partition("@")
    if not found or user.count(":") != 1:
        raise ValueError(
            "with a password file, the database URL names a user and no password: postgresql://USER@HOST/NAME"
        )
    return f"{user}:{quote(password, safe='')}@{rest}"


def settings_of(**given: Any) -> Settings:
    """Settings from the environment, overruled by what is not None. Raises ValueError with one sentence."""
    try:
        return Settings(**{name: value for name, value in given.items() if value is not None})
    except ValidationError as error:
        first = error.errors()[0]
        problem = first["msg"].removeprefix("Value error, ")
        name = str(first["loc"][0]) if first["loc"] else ""
        asked = _said_as(name, given) if name else ""
        raise ValueError(f"{asked}: {problem}" if asked else problem) from None


OPTIONS = {
    "antenna_pattern": "pattern",
    "database_url": "database",
    "emitters": "emitter",
    "keep_sweeps_days": "keep-days",
    "simulate": "flavour",
    "simulated_band_hz": "band",
    "time_factor": "speedup",
    "vehicle_url": "vehicle",
}
"""Settings whose option of the command line has another name."""


def _said_as(name: str, given: Mapping[str, Any]) -> str:
    """Where a setting came from: the option, or the variable of the environment."""
    if given.get(name) is None:
        return f"CROSSFIX_{name.upper()}"
    return "--" + OPTIONS.get(name, name).replace("_", "-")
