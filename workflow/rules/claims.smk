# The paper's statements with their verdicts, and the tests of the results.
RULES["claims"] = {
    "stage": "claims.verdicts",
    "message": "The paper's statements",
    "output": {"claims": result("claims.parquet"), "report": result("claims.md")},
    "place": "checks/claims",
    "runtime": 10,
} | read_tables(reference for claim in config["claims"].values() for reference in claim["tables"].values())
RULES["claims"]["params"]["settings"] = {"claims": config["claims"]}


def tables_of_claim(wildcards):
    """The tables that a statement is read from."""
    return [table(*reference.split("/")) for reference in references_of_claim(wildcards)]


def references_of_claim(wildcards):
    return sorted(set(config["claims"][wildcards.name]["tables"].values()))


def kinds_of_claim(wildcards):
    return {"read": [kind_of(reference) for reference in references_of_claim(wildcards)]}


def settings_of_claim(wildcards):
    return {"claims": {wildcards.name: config["claims"][wildcards.name]}}


RULES["claim"] = {
    "stage": "claims.one_claim",
    "message": "The statement {wildcards.name}, alone",
    "input": {"read": tables_of_claim},
    "output": {"report": result("claims/{name}.md")},
    "place": "checks/claims/{name}",
    "names": {"name": one_of(config["claims"])},
    "runtime": 10,
    "params": {"references": references_of_claim, "kinds": kinds_of_claim, "settings": settings_of_claim},
}


def tables_of_tighter(claim):
    """The tables of a claim by their roles, those of the converged solution with tighter tolerances."""
    tables = config["claims"][claim]["tables"]
    return tables | {role: tighter_reference(config, tables[role]) for role in roles_of_solution(tables)}


TIGHTER = {
    name: config["claims"][name] | {"tables": tables_of_tighter(name)} for name in config["uncertainty"]["claims"]
}

RULES["uncertainty"] = {
    "stage": "claims.uncertainty",
    "message": "How sure the numbers of the paper's statements are",
    "output": {"uncertainty": result("uncertainty.json")},
    "place": "checks/uncertainty",
    "runtime": 10,
} | read_tables(reference for claim in TIGHTER.values() for reference in claim["tables"].values())
RULES["uncertainty"]["input"]["claims"] = result("claims.parquet")
RULES["uncertainty"]["params"]["settings"] = {"claims": TIGHTER}

TESTS = sorted(map(str, Path("tests/results").glob("*.py")))

# The tables that the tests look at; a copy of the project without its tests makes nothing for them.
LOOKED_AT = (
    [
        *tables_of("orbits", *TABLES["orbits"]).values(),
        *tables_of("lyapunov", *TABLES["lyapunov"]).values(),
        *tables_of("precision", *config["precision"]["scenes"]).values(),
        *tables_of("results", *(name for name in TABLES["results"] if name not in ON_REQUEST)).values(),
    ]
    if TESTS and not OWN_MACHINE
    else []
)


def checked_files():
    """What says that the results were tested, where there are tests of them."""
    return [result("checked.txt")] if TESTS and not OWN_MACHINE else []


RULES["check_results"] = {
    "stage": "claims.check_results",
    "message": "Tests of the results",
    "depends": [*LOOKED_AT, *figure_files(), *TESTS],
    "output": {"checked": result("checked.txt")},
    "place": "checks/results",
    "runtime": 10,
    "params": {"results": f"results/{PREFIX}", "figures": config["figures"]},
}
