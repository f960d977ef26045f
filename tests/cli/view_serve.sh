# relief view --serve: a page on this machine alone that follows its file, whatever its clients do.
. "$(dirname "$0")/lib.sh"

printf '<!doctype html>\n<script type="application/json" id="relief-page-data">null</script>\n' >stub.html
export RELIEF_VIEW_PAGE=$work/stub.html
cat >box.obj <<'O'
v 0 0 0
v 1 0 0
v 1 1 0
v 0 1 0
v 0 0 1
v 1 0 1
v 1 1 1
v 0 1 1
f 4 3 2 1
f 5 6 7 8
f 1 2 6 5
f 3 4 8 7
f 2 3 7 6
f 4 1 5 8
O
"$relief" bake box.obj -o b.relief --paper --resolution 32 -q

cat >serve.py <<'P'
import base64, json, os, re, signal, socket, subprocess, sys, time, urllib.request

relief = sys.argv[1]

def start(*arguments):
    child = subprocess.Popen([relief, 'view', *arguments], stdout=subprocess.PIPE, stderr=open('said', 'w'), text=True)
    line = child.stdout.readline()
    found = re.fullmatch(r'http://127\.0\.0\.1:(\d+)/\n', line)
    assert found, (line, open('said').read())
    return child, int(found[1])

def page(port):
    with urllib.request.urlopen(f'http://127.0.0.1:{port}/', timeout=20) as answer:
        assert answer.headers['Content-Type'].startswith('text/html')
        text = answer.read().decode()
    return json.loads(text.split('id="relief-page-data">')[1].split('</script>')[0])

def raw(port, text, timeout=20):
    with socket.create_connection(('127.0.0.1', port), timeout=timeout) as s:
        s.sendall(text)
        got = b''
        while more := s.recv(65536):
            got += more
    return got

def status(port, text):
    return raw(port, text).split(b' ')[1].decode()

def collider(data):
    return base64.b64decode(data['collider'])

def bake(size, output='b.relief'):
    subprocess.run([relief, 'bake', 'box.obj', '-o', output, '--paper', '--resolution', str(size), '-q'], check=True)

class Events:
    def __init__(self, port, path):
        self.socket = socket.create_connection(('127.0.0.1', port), timeout=20)
        self.socket.sendall(f'GET {path} HTTP/1.1\r\nHost: localhost:{port}\r\n\r\n'.encode())
        self.text = b''
        self.until(b'retry: 1000\n\n')

    def until(self, words):
        while words not in self.text:
            more = self.socket.recv(4096)
            assert more, 'the events end'
            self.text += more
        self.text = self.text.split(words, 1)[1]

    def quiet(self, seconds):
        self.socket.settimeout(seconds)
        try:
            assert not self.socket.recv(4096), 'an event without a reason'
            assert False, 'the events end'
        except TimeoutError:
            pass
        self.socket.settimeout(20)

child, port = start('b.relief', '--serve', '0')
first = page(port)
assert first['serve'].startswith('/events') and collider(first) == open('b.relief', 'rb').read()
assert page(port) == first, 'another page without a change'

# Each bake is told once, and then the page is that of the new file.
events = Events(port, first['serve'])
events.quiet(1)
bake(48)
events.until(b'data: ')
second = page(port)
assert collider(second) == open('b.relief', 'rb').read() != collider(first)
events.until(b'\n\n')
events.quiet(1)
# A window that was loaded before it is told as soon as it asks; one loaded afterwards is not.
Events(port, first['serve']).until(b'data: ')
Events(port, second['serve']).quiet(1)

# While the file is damaged or away the last good page stays.
good = open('b.relief', 'rb').read()
def cut():
    with open('new', 'wb') as file:
        file.write(good[:1000])
    os.rename('new', 'b.relief')  # at once: an empty file may be seen otherwise

for spoil in (cut, lambda: os.remove('b.relief')):
    spoil()
    events.quiet(1)
    assert page(port) == second
lines = open('said').read().splitlines()
assert sum('the page stays as it was' in line for line in lines) == 2, lines
bake(40)
events.until(b'data: ')
third = page(port)
assert collider(third) == open('b.relief', 'rb').read()

# Requests that are none of a browser's.
host = f'Host: 127.0.0.1:{port}\r\n'.encode()
get = lambda path: b'GET ' + path + b' HTTP/1.1\r\n' + host + b'\r\n'
assert status(port, get(b'/')) == '200'
assert status(port, get(b'/?x')) == '200'
for path in (b'/b.relief', b'/../../../../etc/passwd', b'/%2e%2e/%2e%2e/etc/passwd', b'//etc/passwd', b'etc/passwd',
             b'/events/../b.relief', b'http://127.0.0.1/b.relief'):
    assert status(port, get(path)) == '404', path
assert status(port, get(b'\xff\0')) == '400'
assert status(port, b'POST / HTTP/1.1\r\n' + host + b'Content-Length: 5\r\n\r\nhello') == '405'
assert status(port, b'\r\n\r\n') in ('400', '403')
assert status(port, b'GET / HTTP/1.1\r\nHost: evil.example\r\n\r\n') == '403'
assert status(port, b'GET /events HTTP/1.1\r\nHost: evil.example:80\r\n\r\n') == '403'
assert status(port, b'GET / HTTP/1.1\r\nX: ' + b'x' * 17000) == '400'
for wanted in (b'0-999999999', b'99999999-', b'-99999999', b'0-1,5-999999999'):  # never beyond the page's end
    assert status(port, b'GET / HTTP/1.1\r\n' + host + b'Range: bytes=' + wanted + b'\r\n\r\n') == '416', wanted
head = raw(port, b'HEAD / HTTP/1.1\r\n' + host + b'\r\n')
assert head.startswith(b'HTTP/1.1 200') and head.endswith(b'\r\n\r\n')

# Clients that say nothing, say it slowly, read nothing, or break off: the page is still to be had, and costs nothing.
idle = [socket.create_connection(('127.0.0.1', port)) for _ in range(100)]
for s in idle[:50]:
    s.sendall(b'GET / HT')
for s in idle[50:60]:
    s.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, b'\1\0\0\0\0\0\0\0')
    s.close()
deadline = time.time() + 15
while True:
    try:
        assert page(port) == third
        break
    except OSError:
        assert time.time() < deadline, 'idle clients keep others out'
        time.sleep(0.5)
streams = []
for i in range(40):
    s = socket.create_connection(('127.0.0.1', port))
    s.sendall(get(b'/events'))
    streams.append(s)
time.sleep(1)
assert page(port) == third, 'streams keep others out'
ticks = lambda: sum(map(int, open(f'/proc/{child.pid}/stat').read().split(')')[1].split()[11:13]))
before = ticks()
time.sleep(2)
assert ticks() - before < 20, 'it is busy with nothing'  # hundredths of a second

for s in streams:
    s.close()
time.sleep(1)
for i in range(40):
    events = Events(port, '/events')  # a window that is gone leaves its place to others
    events.socket.close()
    time.sleep(0.1)

# On 127.0.0.1 and nowhere else.
listening = [line.split()[1] for line in open('/proc/net/tcp').readlines()[1:] if line.split()[3] == '0A']
assert [a for a in listening if a.endswith(f':{port:04X}')] == [f'0100007F:{port:04X}'], listening

# A port that is taken.
taken = subprocess.run([relief, 'view', 'b.relief', '--serve', str(port)], capture_output=True, text=True)
assert taken.returncode == 2 and re.fullmatch(r'relief: error: .*port \d+.*--serve PORT.*\n', taken.stderr), taken

# It ends on a signal, and leaves the port to the next one, although windows are open. They load its page.
child.send_signal(signal.SIGTERM)
assert child.wait(10) == -signal.SIGTERM
child, again = start('b.relief', '--serve', str(port), '--mesh', 'box.obj', '--samples', '2000')
assert again == port
Events(port, third['serve']).until(b'data: ')
data = page(port)
assert data['check'] and data['mesh']

# With a mesh, that is followed too.
events = Events(port, data['serve'])
text = open('box.obj').read()
open('new', 'w').write('# new\n' + text)
os.rename('new', 'box.obj')
events.until(b'data: ')
open('new', 'w').write(text.replace('v 1', 'v 5'))
os.rename('new', 'box.obj')
events.quiet(2)
child.send_signal(signal.SIGINT)
assert child.wait(10) == -signal.SIGINT

# A scene, and a file that it names.
open('scene.toml', 'w').write('[collider]\nfile = "b.relief"\n')
child, port = start('scene.toml', '--serve', '0')
data = page(port)
events = Events(port, data['serve'])
bake(24)
events.until(b'data: ')
assert base64.b64decode(page(port)['files']['b.relief']) == open('b.relief', 'rb').read()
child.kill()
child.wait()
P
python3 serve.py "$relief" || die "serve.py"
[ ! -e b.html ] || die "a page was written"

expect_error 1 'serve' "$relief" view b.relief --serve 65536
expect_error 1 'serve' "$relief" view b.relief --serve x
expect_error 1 'excludes' "$relief" view b.relief --serve 0 -o b.html
expect_error 1 'name the file' "$relief" view - --serve 0
expect_error 2 'missing' "$relief" view missing.relief --serve 0
