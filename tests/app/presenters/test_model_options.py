"""Texts of the model options."""

from app.presenters.model_options import control_texts
from core.mechanics.volume import CONTROLS


def test_every_volume_control_has_its_texts():
    texts = control_texts()
    assert set(texts) == set(CONTROLS), "add it to control_texts()"
    for control, text in texts.items():
        assert text.option, control
        assert text.menu, control
        assert text.curve, control
        assert bool(text.button) == bool(text.tip), control
