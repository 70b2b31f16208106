# SPDX-License-Identifier: BSD-3-Clause
"""What the site has beyond the pages of docs/; MkDocs calls these functions (mkdocs.yml).

Notebooks become pages, because a browser shows no .ipynb. Each key of a scene becomes a link to
itself, so that a message or a colleague can point to it. Pages load nothing from other servers.
"""

import json
import re

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from mkdocs.utils import get_relative_url

KEYS = "reference/keys.md"
SHIM = "https://unpkg.com/iframe-worker/shim"


def on_files(files, config):
    """Replace each notebook by a page with its text and code."""
    for notebook in [file for file in files if file.src_uri.endswith(".ipynb")]:
        files.remove(notebook)
        name = notebook.src_uri.rsplit("/", 1)[-1]
        page = File.generated(
            config,
            notebook.src_uri.replace(".ipynb", ".md"),
            content=page_of(json.loads(notebook.content_string), name),
        )
        files.append(page)
    return files


def page_of(notebook, name):
    """The cells of a notebook as Markdown, and how to run it."""
    parts = []
    for cell in notebook["cells"]:
        text = "".join(cell["source"])
        parts.append(text if cell["cell_type"] == "markdown" else f"```python\n{text}\n```")
    parts.insert(1, f"*The notebook `docs/tutorials/{name}`; [how to run it](README.md).*")
    return "\n\n".join(parts) + "\n"


def on_page_markdown(markdown, page, config, files):
    """Lead links of notebooks to their pages, and give each key an anchor."""
    if page.file.src_uri == KEYS:
        return re.sub(r"^\| `([a-z_.]+)` \|", r"| [`\1`](#\1){ #\1 } |", markdown, flags=re.M)
    return re.sub(r"\]\(([\w/.-]+)\.ipynb\)", r"](\1.md)", markdown)


def on_post_page(output, page, config):
    """Take the script for search in files from the site itself, so that it needs no network."""
    if SHIM not in output:
        raise PluginError(f"{page.file.src_uri} does not load {SHIM}: what does the theme need now?")
    return output.replace(SHIM, get_relative_url("site_worker.js", page.url))


def on_post_template(output_content, template_name, config):
    """Do so in the page of dead addresses, too."""
    return output_content.replace(SHIM, "site_worker.js")
