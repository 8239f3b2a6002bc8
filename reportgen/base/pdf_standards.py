"""The standards that a PDF can follow, by the names that the typesetter and `--standard` use."""

from __future__ import annotations

Standards = tuple[str, ...]
"""Standards that one file follows together; () for none."""

STANDARDS: Standards = ("ua-1", "a-2a")
"""Default standards of every PDF: accessible (ISO 14289-1) and archivable (ISO 19005-2)."""
NONE = "none"
"""Name that stands for no standards in options."""
KNOWN: Standards = (
    *("ua-1", "a-1a", "a-1b", "a-2a", "a-2b", "a-2u", "a-3a", "a-3b", "a-3u", "a-4", "a-4e", "a-4f"),
    *("1.4", "1.5", "1.6", "1.7", "2.0"),
)


def titled(standards: Standards) -> str:
    """Return the usual names of standards: PDF/UA-1, PDF/A-2a, PDF 1.7."""
    return ", ".join(
        f"PDF {name}" if name[0].isdigit() else f"PDF/{name.partition('-')[0].upper()}-{name.partition('-')[2]}"
        for name in standards
    )


def other_than_usual(standards: Standards) -> str:
    """Return the record of the standards that a file was made with: "" for the default ones."""
    return "" if standards == STANDARDS else ",".join(standards) or NONE
