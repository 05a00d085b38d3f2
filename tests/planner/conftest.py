"""Property tests here search without a time limit an example: a busy machine is no defect."""

from hypothesis import settings

settings.register_profile("no-deadline", deadline=None, max_examples=50)
settings.load_profile("no-deadline")
