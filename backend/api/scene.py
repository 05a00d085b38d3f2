"""The 3D scene: what each viewer's scene shows. The scene itself is a page of its own under /scene/."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path

from backend.api.dependencies import ServicesDep
from backend.api.problems import PROBLEM_RESPONSES
from backend.wire.scene import SceneRequest, SceneView

router = APIRouter(prefix="/api/scene", tags=["scene"], responses=PROBLEM_RESPONSES)

ViewId = Annotated[str, Path(pattern=r"^[A-Za-z0-9_-]{8,64}$", description="Made by the page, one a tab")]


@router.put("/views/{view_id}")
async def show_scene(view_id: ViewId, request: SceneRequest, services: ServicesDep) -> SceneView:
    """Say what a view shows; an open frame changes at once."""
    raise NotImplementedError


@router.get("/views/{view_id}")
async def get_scene_view(view_id: ViewId, services: ServicesDep) -> SceneView:
    """What a view shows now."""
    raise NotImplementedError
