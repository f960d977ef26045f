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
:root {
    --ground: #f4f5f7; --card: #fff; --edge: rgb(20 28 40 / 10%); --ink: #1b2027; --soft: #5a6573; --accent: #1d63c9;
    --shade: 0 1px 2px rgb(20 28 40 / 6%), 0 8px 24px rgb(20 28 40 / 8%);
    --lifted: 0 2px 4px rgb(20 28 40 / 8%), 0 16px 40px rgb(20 28 40 / 16%);
    color-scheme: light dark;
    font: 16px/1.55 system-ui, -apple-system, "Segoe UI", Roboto, "Noto Sans", sans-serif;
}
@media (prefers-color-scheme: dark) {
    :root {
        --ground: #14171b; --card: #1e2228; --edge: rgb(255 255 255 / 9%); --ink: #e9ecf0; --soft: #9aa5b3;
        --accent: #6ea8fe; --shade: 0 8px 24px rgb(0 0 0 / 30%); --lifted: 0 16px 40px rgb(0 0 0 / 50%);
    }
}
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink); }
header, main, footer { max-width: 1400px; margin: 0 auto; padding: 0 clamp(16px, 4vw, 56px); }
header { padding-top: clamp(36px, 7vw, 88px); padding-bottom: clamp(24px, 3.5vw, 44px); }
h1 { font-size: clamp(32px, 5vw, 52px); line-height: 1.1; letter-spacing: -.022em; font-weight: 680; margin: 0 0 14px; }
header p { font-size: clamp(16px, 1.6vw, 19px); color: var(--soft); margin: 0; max-width: 46em; text-wrap: balance; }
main { display: grid; grid-template-columns: repeat(6, 1fr); gap: clamp(16px, 2vw, 28px); }
a.scene {
    grid-column: span 2; display: flex; flex-direction: column; overflow: hidden; color: inherit; text-decoration: none;
    background: var(--card); border: 1px solid var(--edge); border-radius: 16px; box-shadow: var(--shade);
    transition: transform .18s ease-out, box-shadow .18s ease-out;
}
a.scene.wide { grid-column: span 3; }
a.scene:hover { transform: translateY(-3px); box-shadow: var(--lifted); }
a.scene:focus-visible { outline: 3px solid var(--accent); outline-offset: 3px; }
/* The pictures are sheets of six frames. One is seen, the last; under the pointer, each in turn. */
.frame { position: relative; aspect-ratio: 382 / 286; overflow: hidden; background: var(--edge); }
.frame img { position: absolute; width: 314.14%; max-width: none; left: -210.47%; top: -108.92%; }
.words { padding: 18px 22px 20px; display: flex; flex-direction: column; flex: 1; }
h2 { font-size: 19px; line-height: 1.3; letter-spacing: -.01em; font-weight: 640; margin: 0 0 4px; }
.words p { margin: 0 0 16px; color: var(--soft); text-wrap: pretty; }
.play { margin-top: auto; color: var(--accent); font-weight: 600; font-size: 15px; }
.play::after { content: "\\2192"; margin-left: .4em; display: inline-block; transition: transform .18s ease-out; }
a.scene:hover .play::after { transform: translateX(4px); }
footer { padding-top: 36px; padding-bottom: 56px; color: var(--soft); font-size: 14px; }
code { font: .92em ui-monospace, "SF Mono", Menlo, Consolas, monospace; }
@media (max-width: 1000px) {
    a.scene { grid-column: span 3; }
    a.scene:first-child { grid-column: span 6; }
}
@media (max-width: 640px) {
    a.scene.wide, a.scene { grid-column: span 6; }
}
@media (hover: hover) and (prefers-reduced-motion: no-preference) {
    a.scene:hover img { animation: frames 3s step-end infinite; }
}
@media (prefers-reduced-motion: reduce) { * { transition: none !important; } }
@keyframes frames {
    0% { left: -3.66%; top: -4.72%; } 16.7% { left: -107.07%; top: -4.72%; } 33.3% { left: -210.47%; top: -4.72%; }
    50% { left: -3.66%; top: -108.92%; } 66.7% { left: -107.07%; top: -108.92%; }
    83.3% { left: -210.47%; top: -108.92%; }
}
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


def card(scene, wide):
    title, sentence = (html.escape(words) for words in title_and_sentence(scene))
    name = html.escape(scene.stem)
    return f'''<a class="scene{' wide' if wide else ''}" href="{name}.html">
<span class="frame"><img src="{name}.jpg" alt=""></span>
<span class="words"><h2>{title}</h2><p>{sentence}</p><span class="play">Play it</span></span>
</a>
'''


def main(folder, *scenes):
    folder = pathlib.Path(folder)
    scenes = [pathlib.Path(scene) for scene in scenes]
    for scene in scenes:
        shutil.copyfile(scene.with_suffix('.jpg'), folder / f'{scene.stem}.jpg')
    # Rows of three; two wide ones lead where that leaves a gap.
    cards = ''.join(card(scene, len(scenes) % 3 == 2 and i < 2) for i, scene in enumerate(scenes))
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
