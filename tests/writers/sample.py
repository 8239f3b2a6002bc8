"""A document that holds every block, inline, expression and scene item, for the tests of both writers."""

from __future__ import annotations

import cmath
import math

from reportgen.base.records import replace
from reportgen.base.template_folders import search_path
from reportgen.base.words import load_words
from reportgen.document import (
    BlankLine,
    Block,
    Cell,
    Column,
    Contents,
    Cover,
    Document,
    Emph,
    Equation,
    Figure,
    InlineMath,
    Inlines,
    LineBreak,
    List,
    PageBreak,
    Paragraph,
    Plate,
    Reference,
    Section,
    Strong,
    Table,
    Text,
    Value,
    Words,
)
from reportgen.drawing import Arc, Arrow, Circle, Hatch, Item, Label, Line, Pen, Polyline, Scene
from reportgen.formula import (
    PI,
    Call,
    Chain,
    Expression,
    Fraction,
    Negative,
    Number,
    Power,
    Product,
    Sum,
    Symbol,
    Term,
    VectorEquation,
    cos,
    sin,
    sqrt,
)

WORDS = Words.among(load_words(search_path("vi")), "vi")

HOSTILE = (
    r"A_B & 100% #1 $x$ \input{…} *y* _z_ @a <b> // c /* d */ `e` [f] ~g^h - i -- j --- k ... "
    r"""l' "m" = n + o / p \\ {q} - 'r' ?`s !`t << u >> ,, v #"w" \u{41}"""
)
"""Text full of every typesetter's marks; it must appear exactly as typed."""

VIETNAMESE = "Ắ ằ Ẳ ẵ Ặ ế Ề ể Ễ ệ ố Ồ ổ Ỗ ộ ớ Ờ ở Ỡ ợ ứ Ừ ử Ữ ự ỳ Ý ỷ Ỹ ỵ đ Đ ĩ Ĩ ũ Ũ"

V_A = Symbol("v", "A")
OMEGA = Symbol("ω", "1")
MU_V = Symbol("μ", "v")
PB = Symbol("pb", over="segment")


def vector(base: str, sub: str = "", sup: str = "") -> Symbol:
    return Symbol(base, sub, sup, over="vector")


def text(string: str) -> Inlines:
    return (Text(string),)


def cells(*strings: str) -> tuple[Cell, ...]:
    return tuple(Cell(text(string)) for string in strings)


# --- expressions ----------------------------------------------------------------------------------


def expressions() -> tuple[Expression, ...]:
    """One expression of every kind, and of every case that needs parentheses."""
    a, b, c = Symbol("a"), Symbol("b"), Symbol("c")
    return (
        a,
        Symbol("p", "3", "′"),
        Symbol("M", "cb"),
        Symbol("ab", over="segment"),
        vector("a", "BA", "n"),
        PI,
        Number(-0.2189, 4, "m/s"),
        Number(60, None, "°"),
        Number(95.0, None, "mm"),
        Number(1234.5, 1, "N·m"),
        Number(98.0, None, "N/cm²"),
        Number(6.0e-3, None, "kg·m²"),
        Sum((a, b, Negative(c))),
        Sum((a, Number(-2.5, 1))),
        a - (b + c),
        2 * (a + b) * c,
        Product((a, Negative(b), Number(-1.5, 1))),
        -(a + b),
        Negative(Negative(a)),
        (a + b) / (a - c),
        Fraction(PI, Number(30)),
        (a + b) ** 2,
        Negative(a) ** 2,
        OMEGA**2,
        (a**2) ** 3,
        (a / b) ** 2,
        sin(Symbol("φ", "1")) ** 2,
        Power(Number(-3.0, 1), Number(2)),
        Power(Number(230.4, 1, "rad/s"), Number(2)),
        Power(a, Negative(Number(1))),
        sqrt(a**2 + b**2),
        Call("sin", (Symbol("φ", "1"),)),
        cos(a + b),
        Call("sin", (Number(35.26, 2, "°"),)),
        Call("arctan2", (a, b)),
        Call("abs", (Symbol("ε", "2"),)),
        a * sin(b) * cos(c),
        (a / b) * c,
        (a * b) / (c * Negative(a)),
        Chain((V_A, OMEGA * Symbol("R"), Number(230.3835, 4) * Number(0.0475, 4), Number(10.943, 3, "m/s"))),
    )


def wide_chain() -> Chain:
    """A chain about three text blocks wide."""
    products = tuple(Number(0.1234 + index, 4) * Number(-12.75, 2) * cos(Number(35.26, 2, "°")) for index in range(4))
    return Chain((Symbol("M", "cb"), Sum(products), Sum(products), Number(-57.31, 2, "N·m")))


def velocity_equation() -> VectorEquation:
    return VectorEquation(
        (
            (Term(vector("v", "B"), ("∥ x", None, None)),),
            (Term(vector("v", "A"), ("⟂ OA", "→", OMEGA * Symbol("R"))), Term(vector("v", "BA"), ("⟂ AB", None, None))),
        ),
        ("phương", "chiều", "độ lớn"),
    )


def force_equation() -> VectorEquation:
    return VectorEquation(
        (
            (
                Term(vector("R", "03"), ("⟂ x", None)),
                Term(vector("P", "3"), ("∥ x", Number(2874.1, 1, "N"))),
                Term(vector("G", "3"), ("↓", Number(22, None, "N"))),
                Term(vector("P", "q3"), ("∥ x", Number(1531.7, 1, "N")), sign=-1),
                Term(vector("R", "12", "n"), ("∥ AB", None)),
                Term(vector("R", "12", "t"), ("⟂ AB", Number(412.6, 1, "N"))),
            ),
            (Term(Symbol("0")),),
        ),
        ("phương", "độ lớn"),
    )


# --- scenes ---------------------------------------------------------------------------------------


def scheme() -> Scene:
    """A crank and a slider: every kind of item, every anchor, a turned label."""
    o, a, b = 25 + 35j, 40 + 50j, 85 + 35j
    frame = (5 + 24j, 45 + 24j, 45 + 28j, 5 + 28j)
    anchors = ("center", "left", "right", "top", "bottom", "top-left", "top-right", "bottom-left", "bottom-right")
    marks: list[Item] = []
    for index, anchor in enumerate(anchors):
        at = 8 + 14 * index + 8j
        marks += [Circle(at, 0.4, None, "#c00000"), Label(at, Symbol("F", str(index)), anchor, 8.0)]
    return Scene(
        130,
        80,
        (
            Line(5 + 35j, 120 + 35j, Pen(0.13, "#606060", (4.0, 1.0, 0.5, 1.0))),
            Hatch(frame, 1.5),
            Polyline(frame, Pen(0.3), closed=True),
            Line(o, a, Pen(0.7)),
            Line(a, b, Pen(0.7)),
            Polyline((75 + 30j, 95 + 30j, 95 + 40j, 75 + 40j), Pen(0.35), closed=True, fill="#e8eef4"),
            *(Circle(point, 1.0, Pen(0.35), "#ffffff") for point in (o, a, b)),
            Arc(o, 12, 0.2, 0.7, Pen(0.2), head=2.0),
            Arc(o, abs(a - o), -0.5, 2.4, Pen(0.13, dash=(1.0, 1.0))),
            Arrow(a, a + 18 * cmath.exp(2.2j), Pen(0.35, "#b00000"), name="v_A"),
            Arrow(b, b + 30, Pen(0.35, "#0040b0"), name="P_3"),
            Arrow(100 + 60j, 101 + 61j, Pen(0.25), name="short"),
            Label(o + 15 + 5j, Symbol("φ", "1"), "left"),
            Label(a + 2, Symbol("A"), "bottom-left"),
            Label(a + 18 * cmath.exp(2.2j), vector("v", "A"), "bottom"),
            Label(b + 30, vector("P", "3"), "bottom"),
            Label(60 + 35j, "x", background=True),
            Label(122 + 45j, HOSTILE[:20], "center", 7.0, turn=90),
            Label(65 + 74j, "Lược đồ: " + VIETNAMESE[:12]),
            *marks,
        ),
        title="a)",
    )


def star(size: float = 40.0, rays: int = 12, title: str = "") -> Scene:
    """Arrows to all sides from the middle, each with its label, for measuring."""
    middle = complex(size / 2, size / 2)
    ends = [
        middle + size * (0.18 + 0.25 * ray / rays) * cmath.exp(2j * math.pi * ray / rays + 0.1j) for ray in range(rays)
    ]
    items: list[Item] = [Arrow(middle, end, Pen(0.25), name=f"pb{ray}") for ray, end in enumerate(ends)]
    items += [
        Label(end + (end - middle) / abs(end - middle) * 2, Symbol("b", str(ray))) for ray, end in enumerate(ends)
    ]
    return Scene(size, size, tuple(items), title)


# --- the document ---------------------------------------------------------------------------------


def cover(title: str = HOSTILE) -> Cover:
    return Cover(
        institution=("Trường Đại học Mẫu", "Khoa Cơ khí", "Bộ môn Kỹ thuật"),
        title=("Thuyết minh", "Bài tập lớn"),
        subtitle=(title,),
        fields=(("Sinh viên", "Đặng Thị Ẩn"), ("Mã số", "A_B-01 & 100%"), ("Lớp", ""), ("Người hướng dẫn", "")),
        place_and_date="Nơi mẫu, ngày … tháng … năm …",
    )


def long_table(rows: int, key: str = "long", number: str = "2.2") -> Table:
    return Table(
        columns=(Column(20, "center"), *(Column(23, "right") for _ in range(5)), Column(20, "left")),
        head=(
            (Cell(text("Vị trí")), Cell(text("Vận tốc"), span=3), Cell(text("Gia tốc"), span=3)),
            (
                Cell(),
                *(
                    Cell((InlineMath(Symbol(base, sub)),))
                    for base, sub in (("v", "A"), ("v", "B"), ("v", "S2"), ("a", "A"), ("a", "B"), ("ε", "2"))
                ),
            ),
        ),
        rows=tuple(
            (
                Cell(text(str(row))),
                *(Cell((Value(Number(math.sin(row + column) * 1000, 2)),)) for column in range(5)),
                Cell((Value(Number(row, None, "°")),)),
            )
            for row in range(1, rows + 1)
        ),
        caption=text("Vận tốc và gia tốc"),
        key=key,
        number=number,
    )


def blocks() -> tuple[Block, ...]:
    chain = expressions()[-1]
    return (
        cover(),
        Contents("Mục lục"),
        Section(1, text("Lời nói đầu"), numbered=False),
        Paragraph(text("Đoạn văn mở đầu, " * 30)),
        Paragraph((Text(HOSTILE),)),
        Paragraph((Text(VIETNAMESE), LineBreak(), Text("dòng sau")), align="center"),
        BlankLine("Chữ ký"),
        BlankLine(),
        Section(1, text("Động học"), key="kinematics", number="1"),
        Section(2, (Text("Vận tốc của "), InlineMath(V_A)), key="velocity", number="1.1"),
        Paragraph(
            (
                Text("Theo "),
                Reference("eq:va", "(1.1)"),
                Text(" và "),
                Reference("fig:scheme", "1.1"),
                Text(" thì "),
                InlineMath(Chain((V_A, Number(10.943, 3, "m/s")))),
                Text(", "),
                Value(Number(-0.2189, 4, "m/s")),
                Text("; "),
                Emph((Text("nghiêng "), Strong(text("đậm nghiêng")))),
                Text(", "),
                Strong(text("đậm")),
                Text("."),
            )
        ),
        Equation((chain,), key="eq:va", number="1.1"),
        Equation((chain, wide_chain()), key="eq:wide", number="1.2"),
        Equation((replace(Chain((Symbol("ε", "1"), Number(0.0, None))), note="vì tay quay quay đều"),)),
        Equation((velocity_equation(),), key="eq:vector", number="1.3"),
        Equation((force_equation(),), key="eq:force", number="1.4"),
        Section(3, text("Các bước dựng"), key="steps", number="1.1.1"),
        List(
            (
                (Paragraph((*text("chọn cực "), InlineMath(Symbol("p")))),),
                (
                    Paragraph((Text("dựng đoạn "), InlineMath(PB))),
                    List(((Paragraph(text("một ý")),), (Paragraph(text("hai ý")),))),
                ),
            ),
            ordered=True,
            start=3,
        ),
        Section(4, text("Nhận xét."), number=""),
        Paragraph(text("Mục này chạy cùng dòng với đoạn văn.")),
        Figure((scheme(),), text("Lược đồ ") + text(HOSTILE), key="fig:scheme", number="1.1"),
        Section(1, text("Mọi biểu thức"), key="all", number="2"),
        *(Equation((expression,)) for expression in expressions()),
        PageBreak(),
        Table(
            columns=(Column(60, "left"), Column(30), Column(30, "right")),
            head=(cells("Đại lượng", "Ký hiệu", "Giá trị"),),
            rows=(
                (Cell(text(HOSTILE)), Cell((InlineMath(OMEGA),)), Cell((Value(Number(230.3835, 4, "rad/s")),))),
                (Cell(text("tỉ xích")), Cell((InlineMath(MU_V),)), Cell((Value(Number(0.2189, 4)),))),
                (Cell(text("ô rộng ba cột"), span=3),),
            ),
            caption=text("Số liệu cho trước"),
            key="given",
            number="2.1",
        ),
        long_table(70),
        Figure(
            tuple(star(46, title=f"{chr(97 + index)})") for index in range(8)),
            text("Họa đồ ở các vị trí"),
            key="fig:plans",
            number="2.1",
        ),
        Plate(star(240, 24), (420.0, 297.0), text("Họa đồ lớn"), key="plate", number="2.2"),
        Section(1, text("Kết luận"), numbered=False, key="end"),
        Paragraph((Text("Xem "), Reference("end", "Kết luận"), Text(" và "), Reference("plate", "2.2"))),
    )


def sample() -> Document:
    """A report of a dozen pages with everything in it."""
    return Document(
        language="vi",
        title="Thuyết minh mẫu",
        author="Đặng Thị Ẩn",
        header=("Bài tập lớn", "Đặng Thị Ẩn – A_B"),
        footer=("", "Trang"),
        words=WORDS,
        blocks=blocks(),
    )


def report(pages: int = 54) -> Document:
    """A report of about `pages` pages in the proportions of a real one, for measuring time."""
    rounds = max(1, pages * 45 // 54)
    body: list[Block] = [cover("Đồ án"), Contents("Mục lục")]
    for index in range(rounds):
        number = f"{index + 1}"
        if index % 5 == 0:
            body.append(Section(1, text("Phần"), number=f"{index // 5 + 1}"))
        body.append(Section(2, text(f"Vị trí {number}"), key=f"s{number}", number=f"{index // 5 + 1}.{number}"))
        for line in range(6):
            body.append(
                Paragraph(
                    (*text("Vận tốc của điểm được tính theo công thức sau. " * 2), Reference(f"s{number}", number))
                )
            )
            row = velocity_equation() if line == 0 else wide_chain() if line == 1 else expressions()[-1]
            body.append(Equation((row,), key=f"e{index}-{line}", number=f"{index}.{line}"))
        scene = star(120 if index % 3 == 0 else 70, 8)
        body.append(Figure((scene,), text("Họa đồ"), key=f"f{number}", number=number))
        if index % 9 == 0:
            body.append(long_table(60, f"t{number}", number))
        elif index % 3 == 0:
            body.append(long_table(8, f"t{number}", number))
    return replace(sample(), blocks=tuple(body))
