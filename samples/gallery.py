#!/usr/bin/env python3
"""Writes the index page of the scenes' pages, and the pictures that it shows: gallery.py FOLDER SCENE.toml…

Each scene's page is FOLDER/NAME.html, made by `relief view`. Titles and sentences are the first words of the scenes, as
far as the first empty line of their comment; pictures are the JPGs beside them.
"""
import html
import pathlib
import re
import shutil
import sys

STYLE = '''
:root { color-scheme: light dark; font: 16px/1.5 system-ui, sans-serif; }
body { max-width: 1300px; margin: 0 auto; padding: 2rem; }
main { display: grid; grid-template-columns: repeat(auto-fill, minmax(320px, 1fr)); gap: 1.5rem; }
a { color: inherit; text-decoration: none; border: 1px solid #8885; border-radius: 12px; overflow: hidden; }
a:hover, a:focus-visible { border-color: #1d63c9; }
/* The pictures are sheets of six frames; the last one is shown. */
.frame { position: relative; display: block; aspect-ratio: 382 / 286; overflow: hidden; }
.frame img { position: absolute; width: 314.14%; left: -210.47%; top: -108.92%; }
.words { display: block; padding: 0 1.2rem; }
'''


def title_and_sentence(scene):
    """'# Rain on hills: a height field…' -> 'Rain on hills', 'A height field….'"""
    lines = []
    for line in scene.read_text(encoding='utf-8').splitlines():
        if not re.match(r'#\s*\S', line):
            break
        lines.append(line.lstrip('#').strip())
    found = re.fullmatch(r'([^:]+): (.+)', ' '.join(lines))
    if not found:
        sys.exit(f'gallery.py: {scene} does not begin with a comment "# TITLE: sentence"')
    title, sentence = found.groups()
    return title, sentence[0].upper() + sentence[1:]


def card(scene):
    title, sentence = (html.escape(words) for words in title_and_sentence(scene))
    name = html.escape(scene.stem)
    return f'''<a class="scene" href="{name}.html">
<span class="frame"><img src="{name}.jpg" alt=""></span>
<span class="words"><h2>{title}</h2><p>{sentence}</p></span>
</a>
'''


def main(folder, *scenes):
    folder = pathlib.Path(folder)
    scenes = [pathlib.Path(scene) for scene in scenes]
    for scene in scenes:
        shutil.copyfile(scene.with_suffix('.jpg'), folder / f'{scene.stem}.jpg')
    cards = ''.join(map(card, scenes))
    (folder / 'index.html').write_text(f'''<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<meta name="color-scheme" content="light dark">
<link rel="icon" href="data:,">
<title>Relief: particles that collide, in WebGL2</title>
<style>{STYLE}</style>
<header>
<h1>Particles that collide</h1>
<p>Relief bakes meshes into depth maps, and lets particles collide with them in one fragment shader. Each scene runs
in your browser, on WebGL2: turn it round, pause it, change the wind.</p>
</header>
<main>
{cards}</main>
<footer>Each page is one file that <code>relief view</code> made of a scene: save it, send it, open it from disk.</footer>
</html>
''', encoding='utf-8')


if __name__ == '__main__':
    main(*sys.argv[1:])
