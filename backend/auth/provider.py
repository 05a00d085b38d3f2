"""Sign-in by OpenID Connect: the code flow with PKCE, state and nonce; authlib speaks it and checks the token.

What a sign-in under way needs stays here, bound to the browser that began it by a cookie, for ten minutes and one use.
"""

from __future__ import annotations

import hmac
import logging
import secrets
import ssl
import time
import warnings
from collections import OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, cast
from urllib.parse import urlsplit

import httpx
from authlib.common.errors import AuthlibBaseError
from joserfc.errors import ExpiredTokenError, JoseError

from backend.auth.keeping import Denied
from backend.auth.provided import UNDER_WAY_S, Provided, Rules, provided
from backend.auth.registry import digest
from backend.reasons.access import ProviderRefused

with warnings.catch_warnings(record=True):  # that it prefers httpx2, which nothing else here speaks
    from authlib.integrations.starlette_client import OAuth

log = logging.getLogger("crossfix.access")

UNDER_WAY = 1000
"""More at once: the oldest is forgotten."""
ANSWERS_S = 10.0
LEEWAY_S = 120
"""Of the provider's clock against this machine's."""
SIGNATURES = ("RS256", "RS384", "RS512", "PS256", "PS384", "PS512", "ES256", "ES384", "ES512", "EdDSA", "Ed25519")
"""With a key of the provider's own: never "none", and no key that both know."""


@dataclass(frozen=True, slots=True)
class UnderWay:
    """browser: digest of its cookie. until_s: on the monotonic clock."""

    browser: str
    redirect_uri: str
    nonce: str
    code_verifier: str
    until_s: float


class Provider:
    """One provider, by its issuer's address."""

    def __init__(
        self,
        issuer: str,
        client_id: str,
        client_secret: str | None,
        rules: Rules,
        *,
        name: str = "",
        monotonic_s: Callable[[], float] = time.monotonic,
    ) -> None:
        """client_secret None: a public client, which PKCE alone protects. name: on the page's button."""
        self.issuer = issuer
        self.name = name or (urlsplit(issuer).hostname or issuer)
        self.rules = rules
        self._client_id = client_id
        self._monotonic_s = monotonic_s
        self._under_way: OrderedDict[str, UnderWay] = OrderedDict()
        registry: Any = OAuth()
        self._client: Any = registry.register(
            "provider",
            client_id=client_id,
            client_secret=client_secret,
            server_metadata_url=f"{issuer.rstrip('/')}/.well-known/openid-configuration",
            client_kwargs={
                "scope": "openid profile email",
                "code_challenge_method": "S256",
                "token_endpoint_auth_method": "none" if client_secret is None else "client_secret_basic",
                "timeout": ANSWERS_S,
                "verify": ssl.create_default_context(),  # once: it takes 40 ms, which an abort would wait for
            },
        )

    async def begin(self, redirect_uri: str) -> tuple[str, str]:
        """Where the browser goes, and the secret of the cookie that it must come back with. Raises Denied."""
        try:
            await self._look()
            made = await self._client.create_authorization_url(redirect_uri)
        except httpx.HTTPError as error:
            raise _away(error) from error
        except (AuthlibBaseError, RuntimeError, ValueError, TypeError, KeyError) as error:
            raise _odd(error) from error
        browser = secrets.token_urlsafe(32)
        until_s = self._monotonic_s() + UNDER_WAY_S
        begun = UnderWay(digest(browser), redirect_uri, made["nonce"], made["code_verifier"], until_s)
        self._under_way[digest(made["state"])] = begun
        if len(self._under_way) > UNDER_WAY:
            self._under_way.popitem(last=False)
        return made["url"], browser

    async def finish(self, query: Mapping[str, str], browser: str | None) -> Provided:
        """Who the provider says has come back. Each state works once. Raises Denied."""
        begun = self._under_way.pop(digest(query.get("state", "")), None)
        if begun is None or self._monotonic_s() >= begun.until_s:
            raise Denied(403, ProviderRefused("return"))
        if browser is None or not hmac.compare_digest(begun.browser, digest(browser)):
            raise Denied(403, ProviderRefused("return"))
        if "error" in query or "code" not in query:
            log.info("the sign-in provider refused: %.200r", query.get("error"))
            raise Denied(403, ProviderRefused("refused"))
        # RFC 9207: a provider that names itself in its answer must be the one that was asked
        if query.get("iss", self.issuer) != self.issuer:
            raise _odd(ValueError(f"the answer came from {query['iss'][:200]!r}"))
        return provided(self.issuer, await self._claims(begun, query["code"]), self.rules)

    async def _claims(self, begun: UnderWay, code: str) -> Mapping[str, Any]:
        wanted: Any = {
            "iss": {"essential": True, "value": self.issuer},
            "aud": {"essential": True, "value": self._client_id},
        }
        try:
            await self._look()
            token = await self._client.fetch_access_token(
                code=code, redirect_uri=begun.redirect_uri, code_verifier=begun.code_verifier
            )
            claims = await self._client.parse_id_token(token, nonce=begun.nonce, claims_options=wanted, leeway=LEEWAY_S)
        except httpx.HTTPError as error:
            raise _away(error) from error
        except ExpiredTokenError as error:
            log.warning("the sign-in provider's token is of another time: %s", error)
            raise Denied(403, ProviderRefused("clock")) from error
        except (AuthlibBaseError, JoseError, RuntimeError, ValueError, TypeError, KeyError) as error:
            raise _odd(error) from error
        if claims is None:
            raise _odd(ValueError("there is no id_token in it"))
        return cast("Mapping[str, Any]", claims)

    async def _look(self) -> None:
        """At what the provider says of itself, once: it must be the one that the settings name (Discovery 4.3), and
        must not lead from https to http. Raises httpx.HTTPError, ValueError."""
        metadata: dict[str, Any] = await self._client.load_server_metadata()
        try:
            if metadata.get("issuer") != self.issuer:
                raise ValueError(f"it calls itself {str(metadata.get('issuer'))[:200]!r}, not {self.issuer!r}")
            for name in ("authorization_endpoint", "token_endpoint", "jwks_uri"):
                if urlsplit(str(metadata.get(name))).scheme not in {"https", urlsplit(self.issuer).scheme}:
                    raise ValueError(f"its {name} is {str(metadata.get(name))[:200]!r}")
        except ValueError:
            metadata.pop("_loaded_at", None)  # asked again next time
            raise
        offered = metadata.get("id_token_signing_alg_values_supported") or ["RS256"]
        accepted = [name for name in SIGNATURES if name in offered]
        metadata["id_token_signing_alg_values_supported"] = accepted or ["RS256"]


def _away(error: Exception) -> Denied:
    log.warning("the sign-in provider does not answer: %s", error)
    return Denied(503, ProviderRefused("away"))


def _odd(error: Exception) -> Denied:
    log.warning("the sign-in provider's answer was refused: %s: %s", type(error).__name__, error)
    return Denied(403, ProviderRefused("answer"))
