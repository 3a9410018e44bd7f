from .axis import spanned as spanned
from .case_view import plot_data as plot_data, plots_json as plots_json, sampling_text as sampling_text
from .forest import Effect as Effect, forest as forest
from .links import case_anchor as case_anchor, fragment as fragment
from .plot import (
    ROW_PIXELS as ROW_PIXELS,
    Plot as Plot,
    Shape as Shape,
    dot as dot,
    row_at as row_at,
    rows_plot as rows_plot,
)
from .rendering import render as render
from .run_page import page_html as page_html
from .stop.drawing import Drawing as Drawing, drawing_of as drawing_of
from .stop.mark import Mark as Mark
from .stop.overlay_view import (
    STEPS as STEPS,
    OverlayView as OverlayView,
    overlay_view as overlay_view,
    script_json as script_json,
)
from .sweep.sweep_page import load_sweep_page as load_sweep_page, sweep_page_html as sweep_page_html
