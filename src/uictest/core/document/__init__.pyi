from .envelope import (
    MANIFEST as MANIFEST,
    RESULT as RESULT,
    Kind as Kind,
    head as head,
    head_of as head_of,
    is_of as is_of,
    require as require,
)
from .table import (
    Cell as Cell,
    Column as Column,
    Data as Data,
    Document as Document,
    Lines as Lines,
    Table as Table,
    Tone as Tone,
)
from .testcases import (
    Suite as Suite,
    Testcase as Testcase,
    TestcaseStatus as TestcaseStatus,
    class_name as class_name,
)
