"""A certificate as files: certification.json, a PNG per picture, and report.html to read."""

from __future__ import annotations

import html
import json
from collections.abc import Iterable, Sequence
from pathlib import Path

from renderer.atomic_file import write_atomically
from renderer.certification.certificate import Certificate, InsideResult, PictureResult
from renderer.certification.panels import write_panel

STYLE = """
body { font: 15px/1.5 system-ui, sans-serif; max-width: 75rem; margin: 2rem auto; padding: 0 1rem; }
table { border-collapse: collapse; margin: 0.5rem 0 1.5rem; }
th, td { padding: 0.15rem 0.7rem; text-align: right; border-bottom: 1px solid #ddd; }
th:first-child, td:first-child { text-align: left; }
.missed { color: #b91c1c; font-weight: 600; }
img { max-width: 100%; }
"""


def write_report(certificate: Certificate, folder: Path) -> Path:
    """Write everything into a folder and return the report's path."""
    folder.mkdir(parents=True, exist_ok=True)
    for result in certificate.pictures:
        write_panel(result, folder / f"{result.case.name}.png")
    figures = json.dumps(certificate.to_dict(), indent=1)
    write_atomically(folder / "certification.json", figures.encode())
    report = folder / "report.html"
    write_atomically(report, html_of(certificate).encode())
    return report


def html_of(certificate: Certificate) -> str:
    """Return the report as a page that needs nothing but the PNGs beside it."""
    aims = certificate.aims()
    verdict = "All aims are met." if all(aim.is_met for aim in aims) else "An aim is missed."
    plan = certificate.plan
    parts = [
        "<!doctype html><html lang=en><meta charset=utf-8><title>Certification</title>",
        f"<style>{STYLE}</style><h1>Our eye beside a path tracer's</h1>",
        f"<p><strong>{verdict}</strong>",
        f" Reference: Mitsuba ({certificate.variant}), {plan.spp} paths per pixel, ",
        f"{plan.size_px} pixels a side. Same surface, index, iris, light and camera; no lids, ",
        "no relief, no subsurface scattering.</p><h2>Aims</h2>",
        table(
            ["aim", "wanted at most, %", "reached, %", "worst at", ""],
            [
                [
                    aim.words,
                    f"{aim.wanted_percent:.2f}",
                    f"{aim.reached_percent:.2f}",
                    aim.worst,
                    "met" if aim.is_met else "MISSED",
                ]
                for aim in aims
            ],
        ),
        *map(_picture, certificate.pictures),
        "<h2>Sunlight inside the chamber</h2>",
        _inside_table(certificate.suns),
        "<h2>Surroundings' light inside the chamber</h2>",
        _inside_table(certificate.skies),
        f"<h2>Layers of the iris, against {plan.layer_steps} steps</h2>",
        table(
            ["integrator", "fetches", "RMS, %", "bias, %"],
            [
                [e.integrator, str(e.fetches), f"{e.rms_percent:.3f}", f"{e.bias_percent:+.3f}"]
                for e in certificate.layers
            ],
        ),
        "</html>",
    ]
    return "".join(parts)


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """Return an HTML table of plain texts."""
    first = "".join(f"<th>{html.escape(cell)}</th>" for cell in head)
    body = "".join(
        "<tr>" + "".join(f"<td{_mark(cell)}>{html.escape(cell)}</td>" for cell in row) + "</tr>"
        for row in rows
    )
    return f"<table><tr>{first}</tr>{body}</table>"


def _mark(cell: str) -> str:
    return " class=missed" if cell == "MISSED" else ""


def _picture(result: PictureResult) -> str:
    case = result.case
    seed, colour = case.iris
    words = f"{colour} iris {seed}, {case.environment}, {case.azimuth_deg:g} degrees"
    rows = [
        [
            name,
            str(score.pixels),
            _channels(score.rms_percent),
            _channels(score.noise_percent),
            _channels(score.rms_without_noise_percent),
            _channels(score.bias_percent),
            f"{score.flip_hdr:.3f}",
            f"{score.flip_ldr:.3f}",
            f"{score.ssim:.3f}",
        ]
        for name, score in result.score.regions.items()
    ]
    head = ["region", "pixels", "RMS R G B, % of maximum", "noise", "RMS without noise"]
    head += ["bias, % of mean", "FLIP HDR", "FLIP LDR", "SSIM"]
    picture = f'<p><img src="{case.name}.png" alt="{words}: ours, path tracer, FLIP, profiles"></p>'
    return f"<h2>{words}</h2>{picture}{table(head, rows)}"


def _channels(values: Sequence[float]) -> str:
    return " ".join(f"{value:.2f}" for value in values)


def _inside_table(results: Sequence[InsideResult]) -> str:
    return table(
        ["light", "error of mean, %", "its noise", "spatial RMS, %", "its noise"],
        [
            [
                result.light,
                f"{result.mean_error_percent:+.2f}",
                f"{result.mean_noise_percent:.2f}",
                f"{result.spatial_rms_percent:.1f}",
                f"{result.spatial_noise_percent:.1f}",
            ]
            for result in results
        ],
    )
