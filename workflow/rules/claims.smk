# The paper's statements with their verdicts, and the tests of the results.
RULES["claims"] = {
    "stage": "claims.verdicts",
    "message": "The paper's statements",
    "output": {"claims": result("claims.parquet"), "report": result("claims.md")},
    "place": "checks/claims",
    "runtime": 10,
} | read_tables(reference for claim in config["claims"].values() for reference in claim["tables"].values())
RULES["claims"]["params"]["settings"] = {"claims": config["claims"]}

TESTS = sorted(map(str, Path("tests/results").glob("*.py")))

# The tables that the tests look at; a copy of the project without its tests makes nothing for them.
LOOKED_AT = (
    [
        *tables_of("orbits", *TABLES["orbits"]).values(),
        *tables_of("lyapunov", *TABLES["lyapunov"]).values(),
        *tables_of("precision", *config["precision"]["scenes"]).values(),
        *tables_of("results", *TABLES["results"]).values(),
    ]
    if TESTS
    else []
)


def checked_files():
    """What says that the results were tested, where there are tests."""
    return [result("checked.txt")] if TESTS else []


RULES["check_results"] = {
    "stage": "claims.check_results",
    "message": "Tests of the results",
    "depends": [*LOOKED_AT, *figure_files(), *TESTS],
    "output": {"checked": result("checked.txt")},
    "place": "checks/results",
    "runtime": 10,
    "params": {"results": f"results/{PREFIX}", "figures": config["figures"]},
}
