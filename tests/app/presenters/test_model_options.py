"""Texts of the model options."""

from app.presenters.model_options import control_texts, defaults, groups, summary, without_effect
from core.document.lower_trunk import LOWER_SETTINGS
from core.mechanics.volume import CONTROLS


def test_every_volume_control_has_its_texts():
    texts = control_texts()
    assert set(texts) == set(CONTROLS), "add it to control_texts()"
    for control, text in texts.items():
        assert text.option, control
        assert text.menu, control
        assert text.curve, control
        assert bool(text.button) == bool(text.tip), control


def test_settings_of_the_other_tissue_are_neither_shown_nor_summed_up():
    net = {key: value for key, value in defaults().items() if key not in LOWER_SETTINGS} | {"tissue": "net"}
    solid = {**net, "tissue": "solid", "firm_chest": 0.1, "member_law": "co-rotated"}
    keys = {setting.key for _, settings in groups() for setting in settings}
    assert without_effect(net) == {"sag", "density", "posture", "prestress"}
    assert "prestress" not in without_effect({**net, "member_law": "prestressed"})
    assert without_effect(solid) == {"firm_chest", "member_law", "prestress", "line_contact"} <= keys
    assert summary(solid) == "Elastic length · Solid with weight"


def test_below_a_solid_bust_the_lower_trunk_keeps_the_settings_of_a_net():
    worn = {**defaults(), "tissue": "solid"}
    assert without_effect(worn) == {"firm_chest", "prestress"}
    assert summary({**worn, "waist_kept": 0.3}).endswith("Solid with weight · Volume kept at waist 30 %")
