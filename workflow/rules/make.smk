# The rules that make tables and pages, from what the stages' files say of them.
for name, one in RULES.items():
    if "stage" not in one:
        continue

    rule:
        name:
            name
        input:
            *one.get("depends", []),
            **one.get("input", {}),
        output:
            *one.get("outputs", []),
            **one.get("output", {}),
        log:
            log_file(one["place"]),
        benchmark:
            benchmark_file(one["place"])
        wildcard_constraints:
            **one.get("names", {}),
        priority: one.get("priority", 0)
        threads: one.get("cores", 1)
        resources:
            **one.get("resources", {}),
            # What a cluster gives a job, and the threads of make.py. Here another job shares its second core (common.smk).
            cpus_per_task=min(one.get("threads", one.get("cores", 1)), WHOLE_MACHINE),
            mem_mb=one.get("mem_mb", 1000),
            runtime=one.get("runtime", 30),
        params:
            **one.get("params", {}),
            asked=asked,
            stage=one["stage"],
            code=source_hash(*sources_of(one)),
        message:
            one["message"]
        script:
            "../../scripts/make.py"
