"""Fails if a file in a folder, or in an archive there, contains one of the given paths of this machine."""

import pathlib
import sys
import tarfile
import zipfile


def contents(path):
    """Names and bytes of the file itself, or of its members if it is an archive."""
    if path.suffix == ".whl":
        with zipfile.ZipFile(path) as archive:
            for name in archive.namelist():
                yield f"{path.name}: {name}", archive.read(name)
    elif path.name.endswith((".tar.gz", ".crate")):
        with tarfile.open(path) as archive:
            for member in archive:
                if member.isfile():
                    yield f"{path.name}: {member.name}", archive.extractfile(member).read()
    else:
        yield path.name, path.read_bytes()


def main():
    folder, *paths = sys.argv[1:]
    # With a trailing slash, a short path such as /root does not match inside another word.
    words = {f"{path.rstrip('/')}/".encode() for path in paths if path.strip("/")}
    words |= {path.encode() for path in paths if path.count("/") > 1}
    found, read = [], 0
    for path in sorted(pathlib.Path(folder).iterdir()):
        for name, data in contents(path):
            read += 1
            found += [f"{name}: {word.decode()}" for word in sorted(words) if word in data]
    if found or not read:
        sys.exit("paths of this machine:\n" + "\n".join(found) if found else f"{folder} is empty")
    print(f"{read} files, no path of this machine")


main()
