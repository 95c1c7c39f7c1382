"""Order codes: written and read back, and refused with what is accepted."""

from __future__ import annotations

import pytest

from study.design.definition import StudyDefinition, read_definition
from study.design.order_codes import OrderCode, OrderCodeError, read_order_code, trials_of_code
from study.design.schedule import schedule

THESIS, LOD = read_definition("thesis"), read_definition("lod")


@pytest.mark.parametrize(
    ("code", "study", "text"),
    [(OrderCode(3, 17, 2**61), LOD, f"3/17/{2**61}"), (OrderCode(None, None, 5), THESIS, "0/0/5")],
)
def test_a_code_survives_being_written(code: OrderCode, study: StudyDefinition, text: str) -> None:
    assert str(code) == text
    assert read_order_code(text, study) == code


def test_a_code_gives_the_trials_again() -> None:
    code = read_order_code("3/17/99", LOD)
    assert trials_of_code(LOD, code) == schedule(LOD, 99, block=3, order_row=17)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("3-17", '"3-17" is no order code; write block/row/seed, such as 3/17/4611'),
        ("13/1/9", '"13/1/9": block 13; lod has blocks 1 to 12'),
        ("0/1/9", '"0/1/9": block 0; lod has blocks 1 to 12'),
        ("1/21/9", '"1/21/9": row 21; lod has rows 1 to 20'),
    ],
)
def test_a_word_that_is_no_code_of_the_study_is_refused(text: str, message: str) -> None:
    with pytest.raises(OrderCodeError) as caught:
        read_order_code(text, LOD)
    assert str(caught.value) == message


def test_a_study_without_blocks_says_so() -> None:
    with pytest.raises(OrderCodeError, match=r'"2/0/9": block 2; thesis has no blocks: write 0'):
        read_order_code("2/0/9", THESIS)
