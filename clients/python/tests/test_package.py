"""What a package index and pip read of the package: metadata, licences, the list of the sdist."""

import re
import shutil
import subprocess
import sys
import tarfile
from importlib.metadata import distribution
from pathlib import Path

import microfacet
import pytest
from packaging.metadata import Metadata

HERE = Path(__file__).parents[1]
LICENCES = {
    "LICENSE-APACHE": "LICENSE-APACHE",
    "LICENSE-MIT": "LICENSE-MIT",
    "LICENSE-TABLES": "tables/LICENSE",
}


def test_metadata_are_valid_and_complete():
    text = distribution("microfacet").read_text("METADATA")
    read = Metadata.from_email(text, validate=True)
    assert str(read.version) == microfacet.__version__
    assert read.license_expression == "(MIT OR Apache-2.0) AND CC0-1.0"
    assert read.license_files == sorted(LICENCES)
    assert read.keywords and read.author and read.summary
    assert read.provides_extra == ["farm", "mitsuba", "plot", "test"]
    assert read.description.strip() == (HERE / "DESCRIPTION.md").read_text().strip()


def test_licences_are_installed():
    for name, path in LICENCES.items():
        installed = distribution("microfacet").read_text(f"licenses/{name}")
        assert installed == (HERE.parents[1] / path).read_text(), name


def test_the_description_has_no_links_into_the_repository():
    links = re.findall(r"\]\(([^)]*)\)", (HERE / "DESCRIPTION.md").read_text())
    assert not [link for link in links if not link.startswith("https://")]


def test_the_sdist_has_what_it_is_built_from_and_nothing_built(tmp_path):
    maturin = shutil.which("maturin", path=Path(sys.executable).parent)
    if maturin is None or shutil.which("cargo") is None:
        pytest.skip("maturin or Rust is not installed")
    subprocess.run([maturin, "sdist", "--out", tmp_path], cwd=HERE, check=True)
    (archive,) = tmp_path.iterdir()
    with tarfile.open(archive) as tar:
        names = {member.name.partition("/")[2] for member in tar if member.isfile()}
    built = {name for name in names if re.search(r"\.(so|pyd|pyc)$|(^|/)target/", name)}
    assert not built
    crates = {"bake", "core", "export", "model", "sampler", "scene", "tables"}
    assert {f"crates/{crate}/Cargo.toml" for crate in crates} <= names
    assert {"PKG-INFO", "pyproject.toml", "Cargo.toml", *LICENCES} <= names
    python = HERE / "python"
    sources = {*python.rglob("*.py"), *python.rglob("*.pyi"), *python.rglob("py.typed")}
    assert {path.relative_to(HERE).as_posix() for path in sources} <= names
    assert "clients/python/Cargo.lock" in names and "clients/python/src/lib.rs" in names
    # Its manifests go together, without those that it leaves out.
    shutil.unpack_archive(archive, tmp_path / "unpacked")
    (manifest,) = tmp_path.glob("unpacked/*/clients/python/Cargo.toml")
    command = ["cargo", "metadata", "--locked", "--quiet", "--format-version", "1"]
    subprocess.run([*command, "--manifest-path", manifest], check=True, stdout=subprocess.DEVNULL)
