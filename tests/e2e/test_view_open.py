"""kerf view --open: the browser gets a private file that leads to the address, not the address itself."""
import os
import re
import stat
import subprocess
import time
from pathlib import Path


def test_the_browser_gets_a_private_file(program, tmp_path):
    seen = tmp_path / "seen.txt"
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\nprintf "%s" "$1" > {seen}.part\nmv {seen}.part {seen}\n')
    browser.chmod(0o755)
    words = [os.environ["KERF"], "view", "--open", program()]
    server = subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "BROWSER": str(browser), "TMPDIR": str(tmp_path)})
    try:
        address = server.stdout.readline().strip()
        for _ in range(100):
            if seen.exists():
                break
            time.sleep(0.1)
        file = Path(seen.read_text())
        assert re.fullmatch(r"http://127\.0\.0\.1:\d+/\?t=[\w-]+", address) and address not in str(file)
        assert f'content="0;url={address}"' in file.read_text()
        assert stat.S_IMODE(file.parent.stat().st_mode) == 0o700
    finally:
        server.terminate()
        server.wait(timeout=60)
    assert not file.parent.exists()


def test_a_missing_browser_leaves_the_server_running(program, tmp_path):
    words = [os.environ["KERF"], "view", "--open", program()]
    server = subprocess.Popen(words, cwd=tmp_path, stdout=subprocess.PIPE, text=True,
                              env={**os.environ, "BROWSER": str(tmp_path / "none")})
    try:
        assert server.stdout.readline().startswith("http://127.0.0.1:")
        time.sleep(0.3)
        assert server.poll() is None
    finally:
        server.terminate()
        assert server.wait(timeout=60) == 0
