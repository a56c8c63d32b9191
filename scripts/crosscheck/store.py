# SPDX-License-Identifier: MIT
# SPDX-FileCopyrightText: 2026 The musurf authors
"""What is finished stays finished: every measurement and every answer of the core lies in a file named after all its inputs.

A key is the SHA-256 of the kind, the inputs (arrays by their bytes) and the versions of whatever made the value. A file is
written beside, synced and renamed, so that a run that is killed leaves whole files only, and the next run goes on from them.
"""
import hashlib
import os
import pathlib
import tempfile

import numpy as np


def digest(*parts):
    """Hexadecimal, of nested lists, dictionaries, texts, numbers and arrays."""
    state = hashlib.sha256()

    def feed(x):
        if isinstance(x, dict):
            feed([[k, x[k]] for k in sorted(x)])
        elif isinstance(x, (list, tuple)):
            state.update(b"[%d" % len(x))
            for one in x:
                feed(one)
        elif isinstance(x, np.ndarray):
            state.update(f"{x.dtype.str}{x.shape}".encode() + np.ascontiguousarray(x).tobytes())
        elif isinstance(x, bytes):
            state.update(b"b%d:" % len(x) + x)
        else:
            word = repr(x).encode()
            state.update(b"%d:" % len(word) + word)

    feed(parts)
    return state.hexdigest()


def of_files(*paths):
    return digest([pathlib.Path(p).read_bytes() for p in paths])


def write(path, data):
    """Beside, synced, then renamed."""
    path = pathlib.Path(path)
    handle, fresh = tempfile.mkstemp(prefix=path.name + ".", dir=path.parent)
    try:
        with os.fdopen(handle, "wb") as file:
            file.write(data if isinstance(data, bytes) else data.encode())
            file.flush()
            os.fsync(file.fileno())
        os.chmod(fresh, 0o644)
        os.replace(fresh, path)
    except BaseException:
        pathlib.Path(fresh).unlink(missing_ok=True)
        raise


class Store:
    """Dictionaries of arrays below a folder, by key."""

    def __init__(self, folder):
        self.folder = pathlib.Path(folder)
        self.folder.mkdir(parents=True, exist_ok=True)

    def path(self, kind, key):
        return self.folder / f"{kind}-{key[:40]}.npz"

    def has(self, kind, key):
        return self.path(kind, key).exists()

    def get(self, kind, key, make):
        path = self.path(kind, key)
        if path.exists():
            try:
                with np.load(path, allow_pickle=False) as file:
                    return {name: file[name] for name in file.files}
            except (OSError, ValueError, EOFError, KeyError) as error:
                raise OSError(f"{path} is damaged ({error}); delete it and start again") from None
        made = {name: np.asarray(value) for name, value in make().items()}
        handle, fresh = tempfile.mkstemp(prefix=path.name + ".", dir=self.folder)
        try:
            with os.fdopen(handle, "wb") as file:
                np.savez_compressed(file, **made)
                file.flush()
                os.fsync(file.fileno())
            os.replace(fresh, path)
        except BaseException:
            pathlib.Path(fresh).unlink(missing_ok=True)
            raise
        return made
