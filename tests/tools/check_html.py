#!/usr/bin/env python3
"""Checks that pages are valid HTML5 and load nothing from other places.

    check_html.py FILE...

Parses each page with html5lib in strict mode (Debian package python3-html5lib). Further checks: ids are unique, links
within the page and to files beside it exist, and each picture is embedded and has an alternative text. Exit codes: 0
all pages are valid, 1 a page has problems, 77 html5lib is not installed.
"""

import sys
from pathlib import Path
from urllib.parse import unquote

try:
    import html5lib
except ImportError:
    print("html5lib is not installed (Debian package python3-html5lib)")
    sys.exit(77)


def problems_of(path):
    """Returns the problems of a page as messages."""
    text = path.read_text(encoding="utf-8")
    try:
        page = html5lib.HTMLParser(strict=True, namespaceHTMLElements=False).parse(text)
    except html5lib.html5parser.ParseError as error:
        return [f"the HTML is not valid: {error}"]
    problems = []
    if page.get("lang") is None:
        problems.append("<html> has no lang")
    ids = [element.get("id") for element in page.iter() if element.get("id") is not None]
    for name in sorted({name for name in ids if ids.count(name) > 1}):
        problems.append(f"two elements have the id {name}")
    for element in page.iter():
        target = element.get("href")
        if target is not None and target.startswith("#"):
            if target[1:] not in ids:
                problems.append(f"no element has the id {target[1:]}")
        elif target is not None and (":" in target or not (path.parent / unquote(target)).is_file()):
            problems.append(f"the link leads to a missing file or to another host: {target}")
        if element.tag == "img" and not element.get("alt"):
            problems.append("a picture has no alternative text")
        source = element.get("src")
        if source is not None and not source.startswith("data:"):
            problems.append(f"the page loads {source}")
    if page.find(".//head/title") is None or page.find(".//h1") is None:
        problems.append("the page has no title or no heading")
    return problems


def main():
    problem_count = 0
    for name in sys.argv[1:]:
        for problem in problems_of(Path(name)):
            print(f"{name}: {problem}")
            problem_count += 1
    return 1 if problem_count else 0


if __name__ == "__main__":
    sys.exit(main())
