#!/usr/bin/env python3
"""Writes the bill of materials (SBOM, SPDX 2.3 as JSON) of binaries that were built on this Debian machine.

sbom.py VERSION OUTPUT BINARY...

Packages, with the versions of this machine: the libraries that the binaries load, and those of
tools/setup/packages.txt that building needs. If a library of that list is not loaded, its headers are compiled into the
binaries (STATIC_LINK). SOURCE_DATE_EPOCH gives the time; without it, it is now.
"""
import datetime, json, os, pathlib, subprocess, sys, time, uuid


def asked(*command):
    """The lines of an answer. A question for several things is answered for those that there are."""
    return subprocess.run(command, capture_output=True, text=True, env={**os.environ, "LC_ALL": "C"}).stdout.splitlines()


def debian_packages(names):
    """Name, version, source and architecture of those that are installed."""
    form = "${db:Status-Status}\t${Package}\t${Version}\t${source:Package}\t${Architecture}\n"
    for line in asked("dpkg-query", "-W", "-f", form, *names) if names else []:
        status, *fields = line.split("\t")
        if status == "installed":
            yield dict(zip(("name", "version", "source", "architecture"), fields))


def loaded_libraries(binary):
    """The files of the libraries that a binary names itself."""
    needed = {line.split("[")[1].split("]")[0] for line in asked("readelf", "-W", "-d", binary) if "(NEEDED)" in line}
    places = dict(line.split(" => ") for line in asked("ldd", binary) if " => " in line)
    return [place.split(" (")[0] for name, place in places.items() if name.strip() in needed and place.startswith("/")]


def loaded_packages(binaries):
    """The packages of the libraries that binaries load; not those of this build."""
    files = {file for binary in binaries for file in loaded_libraries(binary)}
    # Debian lists a library under /lib or /usr/lib, wherever the linker finds it.
    spellings = sorted(files | {"/usr" + file for file in files} | {file.removeprefix("/usr") for file in files})
    owners = {line.split(": ")[0].split(",")[0] for line in asked("dpkg-query", "-S", *spellings)} if files else set()
    return debian_packages(sorted(owner for owner in owners if not owner.startswith("diversion ")))


def packages_for_building():
    listed = pathlib.Path(__file__).resolve().parent.parent / "setup/packages.txt"
    words = [line.split() for line in listed.read_text().splitlines()]
    return debian_packages([of[1] for of in words if of and of[0] == "build"])  # optional ones may be absent


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
    loaded = {package["name"]: package for package in loaded_packages(binaries)}
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
