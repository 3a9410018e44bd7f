from .page import DRAWN as DRAWN, page_html as page_html, worst_first as worst_first
from .rendering import render as render
from .stop.overlay_view import overlay_view as overlay_view
from .sweep.page import sweep_page_html as sweep_page_html
