# SPDX-License-Identifier: GPL-2.0-or-later
"""Settings of Sphinx for the books. script/docs calls it with the pages that stage.py has collected."""
import os

import pygments.lexers.special

project = 'Millwright'
author = 'the authors of Millwright'
copyright = 'the authors of Millwright, GPL-2.0-or-later'
version = release = os.environ['MW_VERSION']
root_doc = 'index'
extensions = ['myst_parser']
source_suffix = {'.md': 'markdown'}
language = 'en'
smartquotes = False
# Links to headings: page.md#heading.
myst_heading_anchors = 4
# No highlighting for pages that name no language.
highlight_language = 'text'

html_theme = 'basic' if os.environ.get('MW_BOOKS_FOR') == 'pdf' else 'sphinx_rtd_theme'
html_title = f'Millwright {version}'
html_static_path = ['static']
html_css_files = ['paper.css' if html_theme == 'basic' else 'screen.css']
html_js_files = [] if html_theme == 'basic' else ['screen.js']
html_copy_source = False
html_show_sourcelink = False
html_show_sphinx = False
html_theme_options = {} if html_theme == 'basic' else {'navigation_depth': 4, 'collapse_navigation': True}

# Languages of examples that Pygments does not know.
PLAIN_LANGUAGES = ('ngc', 'canon', 'error', 'program', 'comp')


def setup(app):
    for name in PLAIN_LANGUAGES:
        app.add_lexer(name, pygments.lexers.special.TextLexer)
