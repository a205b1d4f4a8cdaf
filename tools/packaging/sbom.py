#!/usr/bin/env python3
"""Writes the bill of materials (SBOM, SPDX 2.3 as JSON) of binaries that were built on this Debian machine.

sbom.py VERSION OUTPUT BINARY...

Packages, with the versions of this machine: the libraries that the binaries load, and those of
tools/setup/packages.txt that building needs. If a library of that list is not loaded, its headers are compiled into the
binaries (STATIC_LINK). SOURCE_DATE_EPOCH gives the time; without it, it is now.
"""
import datetime, json, os, pathlib, subprocess, sys, time, uuid


def output(*command):
    return subprocess.run(command, check=True, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"}).stdout


def debian_package(name):
    """Name, version, source and architecture of an installed package; None if it is not installed."""
    form = "${db:Status-Status}\t${Package}\t${Version}\t${source:Package}\t${Architecture}\n"
    asked = subprocess.run(["dpkg-query", "-W", "-f", form, name], capture_output=True, text=True)
    for line in asked.stdout.splitlines():
        status, *fields = line.split("\t")
        if status == "installed":
            return dict(zip(("name", "version", "source", "architecture"), fields))
    return None


def owner(library):
    """The package that a shared library belongs to; None for one of this build. Debian lists it under /lib or /usr/lib."""
    for path in (library, "/usr" + library, library.removeprefix("/usr")):
        asked = subprocess.run(["dpkg-query", "-S", path], capture_output=True, text=True)
        if asked.returncode == 0:
            return debian_package(asked.stdout.split(": ")[0].split(",")[0])
    return None


def loaded_packages(binary):
    """The packages of the libraries that a binary names itself."""
    needed = {line.split("[")[1].split("]")[0] for line in output("readelf", "-W", "-d", binary).splitlines() if "(NEEDED)" in line}
    places = dict(line.split(" => ") for line in output("ldd", binary).splitlines() if " => " in line)
    for name, place in places.items():
        if name.strip() in needed and place.startswith("/"):
            if package := owner(place.split(" (")[0]):
                yield package


def packages_for_building():
    listed = pathlib.Path(__file__).resolve().parent.parent / "setup/packages.txt"
    for line in listed.read_text().splitlines():
        words = line.split()
        if words and words[0] == "build":
            if package := debian_package(words[1]):  # optional ones may be absent
                yield package


def described(package):
    return {
        "SPDXID": "SPDXRef-" + package["name"].replace("+", "-plus"),
        "name": package["name"],
        "versionInfo": package["version"],
        "supplier": "Organization: Debian",
        "downloadLocation": "NOASSERTION",
        "filesAnalyzed": False,
        "licenseConcluded": "NOASSERTION",  # /usr/share/doc/NAME/copyright says more than a word of SPDX could
        "licenseDeclared": "NOASSERTION",
        "copyrightText": "NOASSERTION",
        "sourceInfo": "Debian source package " + package["source"],
        "externalRefs": [{
            "referenceCategory": "PACKAGE-MANAGER",
            "referenceType": "purl",
            "referenceLocator": f"pkg:deb/debian/{package['name']}@{package['version'].replace('+', '%2B').replace(':', '%3A')}"
                                f"?arch={package['architecture']}",
        }],
    }


def main():
    if len(sys.argv) < 4:
        sys.exit("usage: sbom.py VERSION OUTPUT BINARY...")
    version, target, binaries = sys.argv[1], sys.argv[2], sys.argv[3:]
    loaded = {package["name"]: package for binary in binaries for package in loaded_packages(binary)}
    building = {package["name"]: package for package in packages_for_building()}
    if not loaded:
        sys.exit("sbom.py: no library of a Debian package is loaded by " + ", ".join(binaries))

    waymark = "SPDXRef-waymark"
    relations = [("SPDXRef-DOCUMENT", "DESCRIBES", waymark)]
    relations += [(waymark, "DYNAMIC_LINK", described(package)["SPDXID"]) for package in loaded.values()]
    sources = {package["source"] for package in loaded.values()}
    for package in building.values():
        name = described(package)["SPDXID"]
        if not package["name"].endswith("-dev"):
            relations.append((name, "BUILD_TOOL_OF", waymark))
        elif package["source"] in sources:
            relations.append((name, "BUILD_DEPENDENCY_OF", waymark))
        else:
            relations.append((waymark, "STATIC_LINK", name))

    own = {"SPDXID": waymark, "name": "waymark", "versionInfo": version, "supplier": "NOASSERTION",
           "downloadLocation": "NOASSERTION", "filesAnalyzed": False, "licenseConcluded": "NOASSERTION",
           "licenseDeclared": "BSD-3-Clause", "copyrightText": "NOASSERTION"}
    packages = [own] + [described(package) for _, package in sorted({**loaded, **building}.items())]
    created = datetime.datetime.fromtimestamp(int(os.environ.get("SOURCE_DATE_EPOCH", time.time())), datetime.timezone.utc)
    document = {
        "spdxVersion": "SPDX-2.3",
        "dataLicense": "CC0-1.0",
        "SPDXID": "SPDXRef-DOCUMENT",
        "name": f"waymark-{version}",
        "creationInfo": {"created": created.strftime("%Y-%m-%dT%H:%M:%SZ"), "creators": ["Tool: waymark-sbom.py"]},
        "packages": packages,
        "relationships": [{"spdxElementId": a, "relationshipType": kind, "relatedSpdxElement": b} for a, kind, b in sorted(relations)],
    }
    # The same content has the same name.
    content = uuid.uuid5(uuid.NAMESPACE_URL, json.dumps(document, sort_keys=True))
    document["documentNamespace"] = f"https://spdx.org/spdxdocs/waymark-{version}-{content}"
    pathlib.Path(target).write_text(json.dumps(document, indent=1) + "\n")


if __name__ == "__main__":
    main()
