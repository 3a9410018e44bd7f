from .marks import Mark as Mark
from .plot import Effect as Effect, Plot as Plot, forest as forest, spanned as spanned
from .rendering import case_anchor as case_anchor, fragment as fragment, render as render
from .run_page import page_html as page_html
from .stop_plots import (
    STEPS as STEPS,
    Drawing as Drawing,
    drawing_of as drawing_of,
    packed as packed,
    panel_form as panel_form,
    panels_over_time as panels_over_time,
    plot_data as plot_data,
    plots_json as plots_json,
    sampling_text as sampling_text,
    script_json as script_json,
)
from .sweep_page import sweep_page_html as sweep_page_html
