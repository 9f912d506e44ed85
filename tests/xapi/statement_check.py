#!/usr/bin/env python3
# SPDX-License-Identifier: GPL-3.0-or-later
"""Checks statements against the rules of xAPI 1.0.3, part two, as a learning record store must.

    statement_check.py FILE      FILE is a JSON list of statements
"""
import json
import re
import sys
import uuid

UUID = re.compile(r"^[0-9a-fA-F]{8}(-[0-9a-fA-F]{4}){3}-[0-9a-fA-F]{12}$")
IRI = re.compile(r"^[A-Za-z][A-Za-z0-9+.-]*:[^\s<>\"{}|\\^`]+$")
TIME = re.compile(
    r"^\d{4}-(0\d|1[0-2])-([0-2]\d|3[01])T([01]\d|2[0-3]):[0-5]\d:([0-5]\d|60)(\.\d+)?(Z|[+-]\d\d:?\d\d)$"
)
DURATION = re.compile(
    r"^P(?:\d+W|(?=.)(\d+Y)?(\d+M)?(\d+(\.\d+)?D)?(T(?=.)(\d+H)?(\d+M)?(\d+(\.\d+)?S)?)?)$"
)
LANGUAGE = re.compile(r"^[A-Za-z]{2,8}(-[A-Za-z0-9]{1,8})*$")
TOP = {"id", "actor", "verb", "object", "result", "context", "timestamp", "stored", "authority", "version",
       "attachments"}
RESULT = {"score", "success", "completion", "response", "duration", "extensions"}
CONTEXT = {"registration", "instructor", "team", "contextActivities", "revision", "platform", "language", "statement",
           "extensions"}
DEFINITION = {"name", "description", "type", "moreInfo", "extensions", "interactionType", "correctResponsesPattern",
              "choices", "scale", "source", "target", "steps"}


class Bad(ValueError):
    """A statement that breaks a rule."""


def need(condition, text):
    if not condition:
        raise Bad(text)


def number(value):
    return isinstance(value, (int, float)) and not isinstance(value, bool)


def matches(pattern, value):
    return isinstance(value, str) and pattern.match(value) is not None


def members(value, known, name):
    need(isinstance(value, dict), f"{name} is no object")
    need(set(value) <= known, f"{name} has unknown properties: {sorted(set(value) - known)}")
    need(all(v is not None for v in value.values()), f"{name} has a property that is null")


def language_map(value, name):
    need(isinstance(value, dict) and value, f"{name} is no language map")
    for tag, text in value.items():
        need(matches(LANGUAGE, tag) and isinstance(text, str), f"{name}: {tag!r} is no language with a text")


def extensions(value, name):
    need(isinstance(value, dict), f"{name} is no object")
    for key in value:
        need(matches(IRI, key), f"{name}: {key!r} is no IRI")


def check_actor(actor):
    members(actor, {"objectType", "name", "mbox", "mbox_sha1sum", "openid", "account"}, "actor")
    need(actor.get("objectType", "Agent") == "Agent", "the actor is no agent")
    named = [k for k in ("mbox", "mbox_sha1sum", "openid", "account") if k in actor]
    need(len(named) == 1, "an agent has exactly one identifier")
    if "account" in actor:
        members(actor["account"], {"homePage", "name"}, "account")
        need(matches(IRI, actor["account"].get("homePage")), "the account's home page is no address")
        need(isinstance(actor["account"].get("name"), str) and actor["account"]["name"], "the account has no name")


def check_verb(verb):
    members(verb, {"id", "display"}, "verb")
    need(matches(IRI, verb.get("id")), "the verb's id is no IRI")
    if "display" in verb:
        language_map(verb["display"], "display")


def check_object(what):
    members(what, {"objectType", "id", "definition"}, "object")
    need(what.get("objectType", "Activity") == "Activity", "the object is no activity")
    need(matches(IRI, what.get("id")), "the activity's id is no IRI")
    definition = what.get("definition", {})
    members(definition, DEFINITION, "definition")
    for name in ("name", "description"):
        if name in definition:
            language_map(definition[name], name)
    need("type" not in definition or matches(IRI, definition["type"]), "the activity's type is no IRI")
    extensions(definition.get("extensions", {}), "extensions of the definition")


def check_score(score):
    members(score, {"scaled", "raw", "min", "max"}, "score")
    need(all(number(v) for v in score.values()), "a part of the score is no number")
    need(-1 <= score.get("scaled", 0) <= 1, "score.scaled is outside -1 to 1")
    low, high = score.get("min"), score.get("max")
    need(low is None or high is None or low < high, "score.min is not below score.max")
    if "raw" in score:
        need((low is None or low <= score["raw"]) and (high is None or score["raw"] <= high), "score.raw is outside")


def check_result(result):
    members(result, RESULT, "result")
    if "score" in result:
        check_score(result["score"])
    for name in ("success", "completion"):
        need(isinstance(result.get(name, True), bool), f"{name} is no boolean")
    need(isinstance(result.get("response", ""), str), "the response is no text")
    need("duration" not in result or matches(DURATION, result["duration"]), "the duration is not of ISO 8601")
    extensions(result.get("extensions", {}), "extensions of the result")


def check_context(context, activity):
    members(context, CONTEXT, "context")
    need("registration" not in context or matches(UUID, context["registration"]), "the registration is no UUID")
    for name in ("revision", "platform"):
        need(name not in context or (activity and isinstance(context[name], str)), f"{name} is not allowed here")
    need("language" not in context or matches(LANGUAGE, context["language"]), "the language is none")
    extensions(context.get("extensions", {}), "extensions of the context")


def check(statement):
    """Raises Bad with what is wrong."""
    members(statement, TOP, "the statement")
    for name in ("actor", "verb", "object"):
        need(name in statement, f"{name} is missing")
    if "id" in statement:
        need(matches(UUID, statement["id"]), "the id is no UUID")
        need(uuid.UUID(statement["id"]).variant == uuid.RFC_4122, "the id is of another variant")
    check_actor(statement["actor"])
    check_verb(statement["verb"])
    check_object(statement["object"])
    if "result" in statement:
        check_result(statement["result"])
    if "context" in statement:
        check_context(statement["context"], True)
    for name in ("timestamp", "stored"):
        need(name not in statement or matches(TIME, statement[name]), f"{name} is no time of RFC 3339")
    need(str(statement.get("version", "1.0.3")).startswith("1.0."), "the version is not 1.0.x")


def main(file):
    with open(file, encoding="utf-8") as source:
        statements = json.load(source)
    for number_, statement in enumerate(statements):
        try:
            check(statement)
        except Bad as bad:
            print(f"{file}: statement {number_}: {bad}")
            return 1
    print(f"{len(statements)} statements keep the rules")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1]))
